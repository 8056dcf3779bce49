# Every third-party library the suite may link, as one target vendor::<name> each. Its one home is in docs/develop/third_party.md.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(LibLZMA REQUIRED)
find_package(ZLIB REQUIRED)
find_package(embree 3 REQUIRED)

function(suite_vendor name)  # suite_vendor(<name> target-or-library...)
  add_library(vendor_${name} INTERFACE)
  target_link_libraries(vendor_${name} INTERFACE ${ARGN})
  add_library(vendor::${name} ALIAS vendor_${name})
endfunction()

suite_vendor(tbb TBB::tbb Threads::Threads)
suite_vendor(fmt fmt::fmt)
suite_vendor(spdlog spdlog::spdlog)
suite_vendor(cli11 CLI11::CLI11)
suite_vendor(yaml yaml-cpp)
suite_vendor(json nlohmann_json::nlohmann_json)
suite_vendor(crypto OpenSSL::Crypto)
suite_vendor(lzma LibLZMA::LibLZMA)
suite_vendor(zlib ZLIB::ZLIB)
suite_vendor(embree embree)

# Debian's CMake files of these two name targets that its packages do not ship; their pkg-config files are right.
pkg_check_modules(GEOGRAPHICLIB REQUIRED IMPORTED_TARGET geographiclib)
pkg_check_modules(ERFA REQUIRED IMPORTED_TARGET erfa)
suite_vendor(geographiclib PkgConfig::GEOGRAPHICLIB)
suite_vendor(erfa PkgConfig::ERFA)
find_package(PNG REQUIRED)
suite_vendor(png PNG::PNG)

# For installations that bring their libraries along (scripts/wheel): Debian's OpenImageIO pulls in 250 libraries.
set(SUITE_OPENIMAGEIO "" CACHE PATH "folder with include and lib of an OpenImageIO in place of the system's, or empty")
if(SUITE_OPENIMAGEIO)
  file(GLOB OPENIMAGEIO_LIBRARIES ${SUITE_OPENIMAGEIO}/lib/libOpenImageIO*.so*)
  if(NOT OPENIMAGEIO_LIBRARIES)
    message(FATAL_ERROR "SUITE_OPENIMAGEIO: no libOpenImageIO*.so* is in ${SUITE_OPENIMAGEIO}/lib")
  endif()
  suite_vendor(openimageio ${OPENIMAGEIO_LIBRARIES})
  target_include_directories(vendor_openimageio SYSTEM INTERFACE ${SUITE_OPENIMAGEIO}/include)
else()
  pkg_check_modules(OPENIMAGEIO REQUIRED IMPORTED_TARGET OpenImageIO)
  suite_vendor(openimageio PkgConfig::OPENIMAGEIO)
endif()

pkg_search_module(HDF5 REQUIRED IMPORTED_TARGET hdf5-serial hdf5)  # of Debian, of others
suite_vendor(hdf5 PkgConfig::HDF5)

find_library(GEOTIFF_LIBRARY geotiff REQUIRED)
find_path(GEOTIFF_INCLUDE geotiff.h PATH_SUFFIXES geotiff REQUIRED)
pkg_check_modules(TIFF REQUIRED IMPORTED_TARGET libtiff-4)
suite_vendor(geotiff ${GEOTIFF_LIBRARY} PkgConfig::TIFF)
target_include_directories(vendor_geotiff SYSTEM INTERFACE ${GEOTIFF_INCLUDE})

# Optional: OpenVDB volumes. Its CMake module asks for more than is needed.
option(SUITE_OPENVDB "volumes of OpenVDB, where it is found" ON)
find_path(OPENVDB_INCLUDE openvdb/openvdb.h)
find_library(OPENVDB_LIBRARY openvdb)
if(SUITE_OPENVDB AND OPENVDB_INCLUDE AND OPENVDB_LIBRARY)
  suite_vendor(openvdb ${OPENVDB_LIBRARY} TBB::tbb)
  target_include_directories(vendor_openvdb SYSTEM INTERFACE ${OPENVDB_INCLUDE})
  target_compile_options(vendor_openvdb INTERFACE -Wno-deprecated-declarations)
else()
  message(STATUS "without OpenVDB: .vdb files will be refused")
endif()

# Optional: models of FBX, Collada and 3DS.
find_path(ASSIMP_INCLUDE assimp/scene.h)
find_library(ASSIMP_LIBRARY assimp)
if(ASSIMP_INCLUDE AND ASSIMP_LIBRARY)
  suite_vendor(assimp ${ASSIMP_LIBRARY})
  target_include_directories(vendor_assimp SYSTEM INTERFACE ${ASSIMP_INCLUDE})
else()
  message(STATUS "assimp was not found: .fbx, .dae and .3ds files will be refused")
endif()

# Optional: systems of maps beside WGS84, ETRS89 and JGD2011.
find_path(PROJ_INCLUDE proj.h)
find_library(PROJ_LIBRARY proj)
if(PROJ_INCLUDE AND PROJ_LIBRARY)
  suite_vendor(proj ${PROJ_LIBRARY})
  target_include_directories(vendor_proj SYSTEM INTERFACE ${PROJ_INCLUDE})
else()
  message(STATUS "PROJ was not found: maps of other systems than WGS84, ETRS89 and JGD2011 will be refused")
endif()

# Optional: runs on several machines. Of C++ only the C calls are used.
option(SUITE_MPI "runs of several ranks, where MPI is found" ON)
set(MPI_CXX_SKIP_MPICXX ON)
if(SUITE_MPI)
  find_package(MPI COMPONENTS CXX)
endif()
if(MPI_CXX_FOUND)
  suite_vendor(mpi MPI::MPI_CXX)
else()
  message(STATUS "without MPI: runs on several machines go by parts (--part)")
endif()

find_package(pugixml REQUIRED)
suite_vendor(pugixml pugixml::pugixml)

find_package(tinyobjloader REQUIRED)
suite_vendor(tinyobjloader tinyobjloader::tinyobjloader_double)  # georeferenced coordinates need double

# Its implementation is compiled in its home, with nlohmann's json under the name by which it asks for it.
find_path(TINYGLTF_INCLUDE tiny_gltf.h REQUIRED)
find_path(NLOHMANN_INCLUDE json.hpp PATH_SUFFIXES nlohmann REQUIRED)
suite_vendor(tinygltf nlohmann_json::nlohmann_json)
target_include_directories(vendor_tinygltf SYSTEM INTERFACE ${TINYGLTF_INCLUDE} ${NLOHMANN_INCLUDE})

# OpenMesh and CGAL: headers in few translation units, both in libs/mesh only.
find_package(OpenMesh REQUIRED)
suite_vendor(openmesh OpenMeshCore OpenMeshTools)
find_package(CGAL REQUIRED)
suite_vendor(cgal CGAL::CGAL)

if(SUITE_TESTS)
  find_package(GTest REQUIRED)
  find_package(benchmark REQUIRED)
  pkg_check_modules(CHEALPIX REQUIRED IMPORTED_TARGET chealpix)
  suite_vendor(chealpix PkgConfig::CHEALPIX)
endif()
