"""Earth, units, checked parameters, errors and the compiler: what every other room stands on."""
