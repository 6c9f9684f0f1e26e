"""The velocity-aided Kalman filter as a method: the filter, its run on the error model and the strapdown."""
