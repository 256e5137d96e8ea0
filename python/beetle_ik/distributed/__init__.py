"""Work that outgrows one machine: batches and maps in chunks, on the workers of a dask cluster, kept in stores.

It needs the extra `distributed`: dask, and zarr for stores.

    from distributed import Client, LocalCluster
    from beetle_ik import distributed

    client = Client(LocalCluster(n_workers=2, threads_per_worker=1))
    batch = distributed.solve_batch(client, robot, targets, store="batch.zarr")
"""

from .batch import BatchArrays, solve_batch
from .maps import reachability

__all__ = ["BatchArrays", "reachability", "solve_batch"]

# Sets the module names that users see in messages and on pages.
for _public in (BatchArrays, reachability, solve_batch):
    _public.__module__ = "beetle_ik.distributed"
