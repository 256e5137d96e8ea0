"""Work that outgrows one machine: batches in chunks, on the workers of a dask cluster, kept in a store that goes on.

It needs the extra `distributed`: dask, and zarr for stores.

    from distributed import Client, LocalCluster
    from beetle_ik import distributed

    client = Client(LocalCluster(n_workers=2, threads_per_worker=1))
    batch = distributed.solve_batch(client, robot, targets, store="batch.zarr")
"""

from .batch import BatchArrays, solve_batch

__all__ = ["BatchArrays", "solve_batch"]

# Names as users write them, in messages and pages.
BatchArrays.__module__ = solve_batch.__module__ = "beetle_ik.distributed"
