// Of builds with the address sanitizer alone: what is never given back is no finding here, for MPI keeps what it has to the
// end.
extern "C" int __lsan_is_turned_off();
extern "C" int __lsan_is_turned_off() { return 1; }
