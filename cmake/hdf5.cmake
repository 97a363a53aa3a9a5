# hdf5::hdf5 as a static library: Debian's shared one draws in thirty more (curl, LDAP, Kerberos ...), and to load them would be
# most of what a small operator does.
set(HDF5_USE_STATIC_LIBRARIES ON)
find_package(HDF5 REQUIRED COMPONENTS C)
# CMake's own target forgets what the static library needs (szip, zlib)
set_property(TARGET hdf5::hdf5 APPEND PROPERTY INTERFACE_LINK_LIBRARIES ${HDF5_LIBRARIES})
