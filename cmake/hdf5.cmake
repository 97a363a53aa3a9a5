# hdf5::hdf5 as a static library: Debian's shared one draws in thirty more (curl, LDAP, Kerberos ...), and to load them would be
# most of what a small operator does.
set(HDF5_USE_STATIC_LIBRARIES ON)
find_package(HDF5 REQUIRED COMPONENTS C)
# CMake's own target forgets what the static library needs, and HDF5_LIBRARIES has it only where h5cc could be asked: not in a
# folder whose name has a space
find_library(LACON_SZIP sz REQUIRED)
find_library(LACON_ZLIB z REQUIRED)
set_property(TARGET hdf5::hdf5 APPEND PROPERTY INTERFACE_LINK_LIBRARIES ${HDF5_LIBRARIES} "${LACON_SZIP}" "${LACON_ZLIB}" ${CMAKE_DL_LIBS})
