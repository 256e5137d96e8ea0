"""Files of trajectories and tables, which appear complete or not at all.

whole          atomic writing of a file or a folder
csv_table      tables of numbers as CSV
npz            ending and content of npz files
trajectories   trajectories as CSV and npz
derivatives    the derivatives of a trajectory that are continuous
"""
