# Models to sources, while a project is built.
#
# The dependencies of a run of deros (imported models, folders that globs search, definitions of
# messages, deros itself) are in a depfile. One stamp represents its output: files that did not
# change are not touched, so that nothing is compiled unnecessarily.

include_guard(GLOBAL)

cmake_policy(PUSH)
cmake_policy(VERSION 3.22)

# deros_generate(<target>
#                MODEL <file> GENERATOR <name>
#                [OUTPUT_DIRECTORY <folder>] [FILES <file>...]
#                [SOURCE_DIRECTORY <folder>]
#                [INTERFACES <folder>...] [OPTIONS <argument>...]
#                [DEPENDS <target or file>...] [EXCLUDE_FROM_ALL])
#
# Adds a target that keeps what `deros generate MODEL --target GENERATOR` makes up to date.
#
#   OUTPUT_DIRECTORY   where to; by default <current binary folder>/<target>. Left to the target
#                      as its property DEROS_OUTPUT_DIRECTORY
#   FILES              the files that other targets of this folder have as sources, relative to
#                      OUTPUT_DIRECTORY; these targets need add_dependencies(... <target>)
#   SOURCE_DIRECTORY   where the hand-written files of the generated package are kept; by default
#                      the current source folder
#   INTERFACES         folders with .msg, .srv and .action files
#   OPTIONS            options of the generator, as on the command line
#   DEPENDS            what is to be built before, such as models that are themselves generated
function(deros_generate target)
  cmake_parse_arguments(PARSE_ARGV 1 arg
    "EXCLUDE_FROM_ALL" "MODEL;GENERATOR;OUTPUT_DIRECTORY;SOURCE_DIRECTORY"
    "FILES;INTERFACES;OPTIONS;DEPENDS")
  _deros_check_arguments(deros_generate)
  _deros_default(arg_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/${target}" CMAKE_CURRENT_BINARY_DIR)
  _deros_command(command)

  set(state "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${target}.deros")
  set(stamp "${state}/stamp")
  set(depfile "${state}/depends.d")
  # Not every build tool notices that a command has changed; all of them notice a file.
  file(GENERATE OUTPUT "${state}/command" CONTENT "${command}\n")

  set(files "")
  foreach(file IN LISTS arg_FILES)
    list(APPEND files "${arg_OUTPUT_DIRECTORY}/${file}")
  endforeach()
  cmake_path(RELATIVE_PATH arg_MODEL OUTPUT_VARIABLE shown)
  set(forget "")
  if(CMAKE_GENERATOR MATCHES "Makefiles")
    # CMake adds a depfile to its earlier content, so that a deleted file would trigger every build.
    # Without this summary, CMake reads the depfile again.
    set(summary "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${target}.dir/compiler_depend.internal")
    set(forget COMMAND "${CMAKE_COMMAND}" -E rm -f "${summary}")
  endif()
  add_custom_command(
    OUTPUT "${stamp}"
    BYPRODUCTS ${files}
    COMMAND ${command} --overwrite --depfile "${depfile}" --stamp "${stamp}"
    ${forget}
    DEPENDS "${arg_MODEL}" "${state}/command" ${arg_DEPENDS}
    DEPFILE "${depfile}"
    COMMENT "Generating ${arg_GENERATOR} from ${shown}"
    VERBATIM)
  if(arg_EXCLUDE_FROM_ALL)
    add_custom_target(${target} DEPENDS "${stamp}")
  else()
    add_custom_target(${target} ALL DEPENDS "${stamp}")
  endif()
  set_target_properties(${target} PROPERTIES DEROS_OUTPUT_DIRECTORY "${arg_OUTPUT_DIRECTORY}")
  if(files)
    set_source_files_properties(${files} PROPERTIES GENERATED TRUE)
  endif()
endfunction()

# deros_add_monitor(<target>
#                   MODEL <file> [STATIC | OBJECT] [PREFIX <name>]
#                   [OUTPUT_DIRECTORY <folder>]
#                   [INTERFACES <folder>...] [OPTIONS <argument>...] [DEPENDS ...])
#
# Adds a library with the monitor of safety rules in C, freestanding C99 without ROS 2, for firmware
# and for programs of your own. A target that links to it finds its header, robot_monitor.h from
# rules called robot.deros, and is linked to the mathematical library, whose functions rules use. The
# function robot_emit() is yours to define. PREFIX is what the files'
# names begin with, where that is not the name of the model.
function(deros_add_monitor target)
  cmake_parse_arguments(PARSE_ARGV 1 arg
    "STATIC;OBJECT" "MODEL;PREFIX;OUTPUT_DIRECTORY" "INTERFACES;OPTIONS;DEPENDS")
  set(arg_GENERATOR c)
  _deros_check_arguments(deros_add_monitor)
  _deros_default(arg_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/${target}" CMAKE_CURRENT_BINARY_DIR)
  set(kind STATIC)
  if(arg_OBJECT)
    set(kind OBJECT)
  endif()

  if(NOT arg_PREFIX)
    cmake_path(GET arg_MODEL STEM LAST_ONLY name)
    _deros_c_prefix("${name}" arg_PREFIX)
  endif()
  set(files "${arg_PREFIX}_monitor.h" "${arg_PREFIX}_monitor.c")
  deros_generate(${target}_generated
    MODEL "${arg_MODEL}"
    GENERATOR c
    OUTPUT_DIRECTORY "${arg_OUTPUT_DIRECTORY}"
    FILES ${files}
    INTERFACES ${arg_INTERFACES}
    OPTIONS ${arg_OPTIONS}
    DEPENDS ${arg_DEPENDS}
    EXCLUDE_FROM_ALL)

  list(TRANSFORM files PREPEND "${arg_OUTPUT_DIRECTORY}/")
  add_library(${target} ${kind} ${files})
  add_dependencies(${target} ${target}_generated)
  target_include_directories(${target} PUBLIC "$<BUILD_INTERFACE:${arg_OUTPUT_DIRECTORY}>")
  target_compile_features(${target} PUBLIC c_std_99)
  # Rules are computed alike on every processor: a fused multiply-add would round once, not twice.
  target_compile_options(${target} PRIVATE
    "$<$<C_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off>")
  set_target_properties(${target} PROPERTIES LINKER_LANGUAGE C)
  if(NOT MSVC) # there, the functions of math.h are in the library that every program has
    target_link_libraries(${target} PUBLIC m)
  endif()
endfunction()

# deros_package(MODEL <file> GENERATOR <name>
#               [SOURCE_DIRECTORY <folder>]
#               [INTERFACES <folder>...] [OPTIONS <argument>...])
#
# Generates a whole ament_cmake package and builds it as part of this one, which has its name. The
# hand-written files, package.xml among them, are kept in SOURCE_DIRECTORY, by default the current
# source folder; `deros generate MODEL --target GENERATOR --scaffold <folder>` writes them once.
#
# The generated CMakeLists.txt must be there when CMake runs. So this generates while the project is
# configured, and has it configured anew when something changes that the package rests on.
macro(deros_package)
  include(CTest) # tests of a subdirectory run only if the folders above know of them
  _deros_generate_package(_deros_package ${ARGV})
  add_subdirectory("${_deros_package}" deros_package)
  unset(_deros_package)
endmacro()

# Generates the package, and sets `result` to its folder.
function(_deros_generate_package result)
  cmake_parse_arguments(PARSE_ARGV 1 arg
    "" "MODEL;GENERATOR;SOURCE_DIRECTORY" "INTERFACES;OPTIONS")
  _deros_check_arguments(deros_package)
  set(arg_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/deros_generated")
  _deros_command(command)

  set(state "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/deros_package.deros")
  set(depfile "${state}/depends.d")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${arg_MODEL}")
  if(EXISTS "${depfile}")
    # From the run before: if this one fails, what it rests on is not known.
    _deros_configure_depends("${depfile}")
  endif()
  execute_process(
    COMMAND ${command} --overwrite --depfile "${depfile}" --stamp "${state}/stamp"
    WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
    OUTPUT_QUIET
    ERROR_VARIABLE said
    RESULT_VARIABLE failed)
  if(said)
    message(NOTICE "${said}")
  endif()
  if(failed)
    message(FATAL_ERROR "deros made nothing of ${arg_MODEL}")
  endif()
  _deros_configure_depends("${depfile}")

  file(STRINGS "${state}/stamp" files REGEX "^[^/]*/CMakeLists\\.txt$")
  if(NOT files)
    message(FATAL_ERROR
      "deros_package: the generator ${arg_GENERATOR} makes no CMake package of ${arg_MODEL}; \
deros_generate is for other outputs")
  endif()
  list(GET files 0 script)
  cmake_path(GET script PARENT_PATH package)
  if(NOT package STREQUAL PROJECT_NAME)
    message(FATAL_ERROR
      "deros_package: the generated package is ${package}: call this one so, with project(${package})")
  endif()
  set(${result} "${arg_OUTPUT_DIRECTORY}/${package}" PARENT_SCOPE)
endfunction()

# Helpers; they set the caller's arg_* variables -------------------------------------------------

macro(_deros_check_arguments function)
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "${function}: what is '${arg_UNPARSED_ARGUMENTS}'?")
  endif()
  foreach(keyword IN LISTS arg_KEYWORDS_MISSING_VALUES)
    if(NOT keyword MATCHES "^(FILES|INTERFACES|OPTIONS|DEPENDS)$") # lists may be empty
      message(FATAL_ERROR "${function}: ${keyword} lacks its value")
    endif()
  endforeach()
  foreach(keyword MODEL GENERATOR)
    if(NOT arg_${keyword})
      message(FATAL_ERROR "${function}: ${keyword} is not given")
    endif()
  endforeach()
  cmake_path(ABSOLUTE_PATH arg_MODEL BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
  if(NOT EXISTS "${arg_MODEL}" AND NOT arg_DEPENDS)
    message(FATAL_ERROR "${function}: there is no model ${arg_MODEL}")
  endif()
endmacro()

macro(_deros_default variable value base)
  if(NOT ${variable})
    set(${variable} "${value}")
  endif()
  cmake_path(ABSOLUTE_PATH ${variable} BASE_DIRECTORY "${${base}}" NORMALIZE)
endmacro()

# Sets `result` to the prefix of all names of a program that the C generator emits.
function(_deros_c_prefix name result)
  string(REGEX REPLACE "[^A-Za-z0-9_]+" "_" name "${name}")
  string(REGEX REPLACE "([a-z0-9])([A-Z])" "\\1_\\2" name "${name}")
  string(TOLOWER "${name}" name)
  string(REGEX REPLACE "^_+|_+$" "" name "${name}")
  string(REGEX REPLACE "^([0-9])" "rules_\\1" name "${name}")
  set(${result} "${name}" PARENT_SCOPE)
endfunction()

# Sets `result` to the command for the caller's arguments. The folders of message definitions are
# fixed here: a build from an editor lacks the environment of the shell that configured the project.
function(_deros_command result)
  _deros_default(arg_SOURCE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" CMAKE_CURRENT_SOURCE_DIR)
  set(command
    "${CMAKE_COMMAND}" -E env "AMENT_PREFIX_PATH=$ENV{AMENT_PREFIX_PATH}"
    "${deros_EXECUTABLE}" generate "${arg_MODEL}"
    --target "${arg_GENERATOR}"
    --output "${arg_OUTPUT_DIRECTORY}"
    --source "${arg_SOURCE_DIRECTORY}")
  foreach(folder IN LISTS arg_INTERFACES)
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND command --interfaces "${folder}")
  endforeach()
  set(${result} ${command} ${arg_OPTIONS} PARENT_SCOPE)
endfunction()

# Reconfigures the project when a file in the depfile changes.
function(_deros_configure_depends depfile)
  file(READ "${depfile}" text)
  string(STRIP "${text}" text)
  string(REPLACE " \\\n  " ";" paths "${text}")
  list(POP_FRONT paths) # the target
  foreach(path IN LISTS paths)
    string(REGEX REPLACE "\\\\([ \t#])" "\\1" path "${path}")
    string(REPLACE "$$" "$" path "${path}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${path}")
  endforeach()
endfunction()

cmake_policy(POP)
