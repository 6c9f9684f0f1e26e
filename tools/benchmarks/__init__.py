"""The strapdown engine beside another, on identical work (``make benchmarks``, extra ``benchmarks``)."""
