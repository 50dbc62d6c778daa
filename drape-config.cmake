# find_package(drape): the libraries drape::solver, drape::model, drape::reference and drape::results, and the function
# drape_plugin(<name> <sources>...), a shared library of methods that `bench_integrators --plugin` loads.
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_EXTENSIONS OFF)
include(${CMAKE_CURRENT_LIST_DIR}/libraries.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/drape-targets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/plugin.cmake)
