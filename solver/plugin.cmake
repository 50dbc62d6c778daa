# For our own build and, installed, for find_package(drape).

# Sets a variable to the flags of this build and these options, without warnings: those that change what is computed.
function(drape_flags_text variable options)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
  set(${variable} "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}} $<JOIN:$<FILTER:${options},EXCLUDE,^-W>, >" PARENT_SCOPE)
endfunction()

# Tells sources that include solver/plugin.hpp what a target is compiled with: `options` are those of ours.
function(drape_tell_flags target options)
  drape_flags_text(flags "${options}")
  target_compile_definitions(${target} PRIVATE "DRAPE_COMPILE_FLAGS=\"${flags}\"")
endfunction()

# A shared library with methods or forces. The functions that it calls are those in the program: only headers and flags are its own.
function(drape_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE drape::drape_flags)
  drape_tell_flags(${name} $<TARGET_PROPERTY:${name},COMPILE_OPTIONS>)
endfunction()
