# find_package(deros): the program `deros`, and functions that run it while a project is built.
#
#   deros_EXECUTABLE   the program; set it beforehand to use another one
#
# Functions: deros_generate, deros_add_monitor, deros_package; see derosFunctions.cmake.

if(CMAKE_VERSION VERSION_LESS "3.22")
  set(deros_FOUND FALSE)
  set(deros_NOT_FOUND_MESSAGE "deros needs CMake 3.22 or later")
  return()
endif()

# This file lies in <prefix>/share/deros/cmake, and in the package's own folder, which is
# <prefix>/lib/pythonX.Y/site-packages/deros/cmake; the program belonging to it in <prefix>/bin.
# A checkout has no such place: then it is the first on the PATH.
find_program(deros_EXECUTABLE deros
  HINTS
    "${CMAKE_CURRENT_LIST_DIR}/../../../bin"
    "${CMAKE_CURRENT_LIST_DIR}/../../../../../bin"
    "${CMAKE_CURRENT_LIST_DIR}/../../../../bin"
  NO_DEFAULT_PATH
  DOC "The program deros")
find_program(deros_EXECUTABLE deros DOC "The program deros")
mark_as_advanced(deros_EXECUTABLE)

if(NOT deros_EXECUTABLE)
  set(deros_FOUND FALSE)
  set(deros_NOT_FOUND_MESSAGE
    "there is no program 'deros' beside ${CMAKE_CURRENT_LIST_DIR}, and none on the PATH: \
run 'pip install deros', or set deros_EXECUTABLE")
  return()
endif()

# The functions are those of the program, whichever it is: they know its options.
execute_process(
  COMMAND "${deros_EXECUTABLE}" cmake-dir
  OUTPUT_VARIABLE _deros_functions
  OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_VARIABLE _deros_said
  RESULT_VARIABLE _deros_failed)
if(NOT _deros_failed EQUAL 0)
  set(deros_FOUND FALSE)
  set(deros_NOT_FOUND_MESSAGE "${deros_EXECUTABLE} does not run: ${_deros_said}${_deros_failed}")
  return()
endif()
include("${_deros_functions}/derosFunctions.cmake")
unset(_deros_functions)
unset(_deros_said)
unset(_deros_failed)
