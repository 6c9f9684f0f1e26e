"""Containers of named columns, a module each: Parquet, MAT, HDF5, NetCDF and npz."""
