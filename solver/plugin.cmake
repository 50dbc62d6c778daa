# For our own build and, installed, for find_package(drape).

# Tells sources that include solver/plugin.hpp what a target is compiled with: `flags` are the options of ours.
function(drape_tell_flags target flags)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
  target_compile_definitions(${target} PRIVATE
    "DRAPE_COMPILE_FLAGS=\"${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}} $<JOIN:$<FILTER:${flags},EXCLUDE,^-W>, >\"")
endfunction()

# A shared library with methods. The functions of the solver that it calls are those in the program: only headers and flags are its own.
function(drape_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE drape::drape_flags)
  drape_tell_flags(${name} $<TARGET_PROPERTY:${name},COMPILE_OPTIONS>)
endfunction()
