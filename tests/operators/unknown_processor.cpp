// Loaded before OpenBLAS (LD_PRELOAD): what it says of itself on a processor that it does not know.
extern "C" const char* openblas_get_corename() { return "Prescott"; }
