# The house rules of the build: one function per kind of target, and a configuration that fails when a library looks
# up or to its right. The order below is the drawing in README.md read row by row from the ground, left to right.
set(SUITE_ORDER base math page  spectral motion sqt sqt_fit  optics water air thermal scene mesh  sensor detection trace surface light estimate transport scheduler heat cluster study correction lidar)
set(SUITE_ROW_OF_base 0)
set(SUITE_ROW_OF_math 0)
set(SUITE_ROW_OF_page 0)
foreach(lib spectral motion sqt sqt_fit)
  set(SUITE_ROW_OF_${lib} 1)
endforeach()
foreach(lib optics water air thermal scene mesh)
  set(SUITE_ROW_OF_${lib} 2)
endforeach()
foreach(lib sensor detection trace surface light estimate transport scheduler heat cluster study correction lidar)
  set(SUITE_ROW_OF_${lib} 3)
endforeach()

# Flags every target of ours is built with; vendors' headers are system headers and stay out of the warnings.
add_library(suite_flags INTERFACE)
target_compile_features(suite_flags INTERFACE cxx_std_20)
# -Wrestrict of g++ 12 reports overlaps in std::string that cannot happen (GCC bug 105329).
target_compile_options(suite_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Werror -Wno-restrict
                                             -ffp-contract=off -march=${SUITE_ARCH})
target_include_directories(suite_flags INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/libs)
if(CMAKE_UNITY_BUILD)
  # Types of an unnamed namespace in a header are a fault; g++ takes the sources of a batch for headers.
  target_compile_options(suite_flags INTERFACE -Wno-subobject-linkage)
endif()
if(SUITE_SANITIZE)
  # The instrumentation hides initialisations from g++ 12, whose manual warns of false warnings with sanitizers.
  target_compile_options(suite_flags INTERFACE -fsanitize=${SUITE_SANITIZE} -fno-omit-frame-pointer
                                               -fno-sanitize-recover=all -Wno-maybe-uninitialized)
  target_link_options(suite_flags INTERFACE -fsanitize=${SUITE_SANITIZE})
endif()

function(_suite_target name sources uses vendor)
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC suite_flags)
  foreach(use ${uses})
    target_link_libraries(${name} PUBLIC ${use})
  endforeach()
  foreach(lib ${vendor})
    target_link_libraries(${name} PRIVATE ${lib})
  endforeach()
endfunction()

# suite_library(<name> ROW n SOURCES ... USES ... VENDOR ...): a library of libs/. USES may name only libraries below or
# to the left; vendors are linked PRIVATE.
function(suite_library name)
  cmake_parse_arguments(A "" "ROW" "SOURCES;USES;VENDOR" ${ARGN})
  if(NOT "${A_ROW}" STREQUAL "${SUITE_ROW_OF_${name}}")
    message(FATAL_ERROR "libs/${name} says row '${A_ROW}', the drawing in scripts/cmake/suite.cmake says '${SUITE_ROW_OF_${name}}'")
  endif()
  list(FIND SUITE_ORDER ${name} mine)
  foreach(use ${A_USES})
    list(FIND SUITE_ORDER ${use} theirs)
    if(theirs EQUAL -1 OR theirs GREATER_EQUAL mine)
      message(FATAL_ERROR "libs/${name} uses '${use}', which is above it, to its right, or no library of libs/")
    endif()
  endforeach()
  _suite_target(${name} "${A_SOURCES}" "${A_USES}" "${A_VENDOR}")
endfunction()

# suite_format(<name> SOURCES ... USES ... VENDOR ...): a reader/writer of formats/, target format_<name>.
function(suite_format name)
  cmake_parse_arguments(A "" "" "SOURCES;USES;VENDOR" ${ARGN})
  _suite_target(format_${name} "${A_SOURCES}" "${A_USES}" "${A_VENDOR}")
endfunction()

# suite_part(<name> FOR target SOURCES ... VENDOR ...): a shared library that the programs which link `target` load when
# they need it (libs/base/late_part.h). It links vendors and nothing of ours, so that nothing of ours is there twice.
function(suite_part name)
  cmake_parse_arguments(A "" "FOR" "SOURCES;VENDOR" ${ARGN})
  add_library(part_${name} MODULE ${A_SOURCES})
  target_link_libraries(part_${name} PRIVATE suite_flags ${A_VENDOR})
  target_compile_definitions(part_${name} PRIVATE SUITE_VERSION="${PROJECT_VERSION}")
  set_target_properties(part_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/suite)
  add_dependencies(${A_FOR} part_${name})
  install(TARGETS part_${name} LIBRARY DESTINATION lib/suite)
endfunction()

# suite_texts(<function> TYPE t HEADER h ENTRIES variable): writes <function>.cpp into the binary folder, which defines what the header
# declares: a list of texts inside the library, so that no file is looked for when one is asked for.
function(suite_texts function)
  cmake_parse_arguments(A "" "TYPE;HEADER;ENTRIES" "" ${ARGN})
  set(entries "${${A_ENTRIES}}")  # by its variable's name: as an argument it would be parted at semicolons
  file(CONFIGURE OUTPUT ${function}.cpp CONTENT [[
// Written by suite_texts() of scripts/cmake/suite.cmake.
#include "@A_HEADER@"

namespace suite {

const std::vector<@A_TYPE@>& @function@() {
  static const std::vector<@A_TYPE@> texts{
@entries@  };
  return texts;
}

}  // namespace suite
]] @ONLY)
endfunction()

# suite_app(<name> SOURCES ... USES ... VENDOR ...): an executable of apps/. All but main.cpp go into a library so that tests can link it.
function(suite_app name)
  cmake_parse_arguments(A "" "" "SOURCES;USES;VENDOR" ${ARGN})
  string(REPLACE "-" "_" library app_${name})
  _suite_target(${library} "${A_SOURCES}" "${A_USES}" "${A_VENDOR}")
  add_executable(${name} main.cpp $<TARGET_OBJECTS:suite_start>)
  target_link_libraries(${name} PRIVATE ${library})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  install(TARGETS ${name} RUNTIME DESTINATION bin)
endfunction()

# suite_c_library(<name> HEADER h SOURCES ... USES ...): a shared library of apps/ with a plain C header, for other programs and
# languages. Only what the header declares can be seen from outside.
function(suite_c_library name)
  cmake_parse_arguments(A "" "HEADER" "SOURCES;USES" ${ARGN})
  add_library(${name} SHARED ${A_SOURCES})
  target_link_libraries(${name} PRIVATE suite_flags ${A_USES})
  target_link_options(${name} PRIVATE LINKER:--version-script=${CMAKE_CURRENT_SOURCE_DIR}/${name}.map LINKER:--no-undefined)
  # The loader refuses it on a lesser processor; programs say so themselves (apps/start).
  if(SUITE_ARCH MATCHES "^x86-64-v[234]$")
    target_link_options(${name} PRIVATE LINKER:-z,${SUITE_ARCH})
  endif()
  set_target_properties(${name} PROPERTIES VERSION 1.0 SOVERSION 1 LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
                        LINK_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}.map)
  install(TARGETS ${name} LIBRARY DESTINATION lib)
  install(FILES ${A_HEADER} DESTINATION include)
endfunction()

# suite_forbid(<target> libraries...): the configuration fails when the target links one of them, by whatever way.
function(suite_forbid target)
  set(open ${target})
  set(seen)
  while(NOT "${open}" STREQUAL "")
    list(POP_FRONT open one)
    if(NOT TARGET ${one} OR one IN_LIST seen)
      continue()
    endif()
    list(APPEND seen ${one})
    if(one IN_LIST ARGN)
      message(FATAL_ERROR "${target} links '${one}', which it must not")
    endif()
    get_target_property(links ${one} LINK_LIBRARIES)
    get_target_property(passed ${one} INTERFACE_LINK_LIBRARIES)
    # A private link of a static library appears as $<LINK_ONLY:name>.
    list(TRANSFORM passed REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1")
    list(APPEND open ${links} ${passed})
  endwhile()
endfunction()

# What sanitizers must not count: leaks of libraries that are not ours, and tasks that TBB hands from thread to thread.
set(SUITE_SUPPRESSIONS "LSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/fuzz/leaks_of_libraries.txt:print_suppressions=0"
                "TSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/support/races_of_libraries.txt:print_suppressions=0")

# The name of a test from its place: "optics/ward" in tests/unit is unit_optics_ward, of tests/unit/optics/ward_test.cpp.
# <library> is a folder of libs, format_<folder> of formats, or a folder of apps with _ for -.
function(_suite_test_name place name label)
  get_filename_component(folder ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  if(NOT place MATCHES "^[a-z0-9_]+/[a-z0-9_]+$")
    message(FATAL_ERROR "tests/${folder}: '${place}' is not <library>/<subject>")
  endif()
  string(REPLACE "/" "_" flat ${place})
  set(${name} ${folder}_${flat} PARENT_SCOPE)
  set(${label} ${folder} PARENT_SCOPE)
endfunction()

# The Python of tests: the system's, whose packages scripts/install brings, before whatever stands first on the PATH. A version
# manager's stand-in for it takes a tenth of a second of the processor a start, and the tests start it some hundred times.
find_program(SUITE_TEST_PYTHON python3 HINTS /usr/bin DOC "The interpreter of the tests")
set(SUITE_TEST_PATH ${CMAKE_BINARY_DIR}/tests/path)
if(SUITE_TEST_PYTHON)
  file(MAKE_DIRECTORY ${SUITE_TEST_PATH})
  file(CREATE_LINK ${SUITE_TEST_PYTHON} ${SUITE_TEST_PATH}/python3 SYMBOLIC)
endif()

# suite_entry(<name> COMMAND ... [LABEL l] [TIMEOUT s] [PASS regex] [ENVIRONMENT ...]): one ctest entry, measured. Its label is that of
# the folder, the seconds after which it is ended follow from tests/seconds.tsv. A name that the table does not hold has
# SUITE_UNKNOWN_TIMEOUT of them, and the test seconds_table says which line to add. TIMEOUT is for the long runs.
function(suite_entry name)
  cmake_parse_arguments(A "" "LABEL;TIMEOUT;PASS" "COMMAND;ENVIRONMENT" ${ARGN})
  if(NOT A_COMMAND OR A_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "suite_entry(${name}): expected COMMAND and known words, got '${A_UNPARSED_ARGUMENTS}'")
  endif()
  if(NOT A_LABEL)
    get_filename_component(A_LABEL ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  endif()
  set(processor unlimited)
  if(NOT A_TIMEOUT)
    set(A_TIMEOUT ${SUITE_UNKNOWN_TIMEOUT})
    if(DEFINED SUITE_TIMEOUT_${name})
      set(A_TIMEOUT ${SUITE_TIMEOUT_${name}})
      set(processor ${SUITE_PROCESSOR_${name}})
    endif()
  endif()
  set(labels ${A_LABEL})
  if("${name}" IN_LIST SUITE_QUICK)
    list(APPEND labels quick)
  endif()
  add_test(NAME ${name} COMMAND ${PROJECT_SOURCE_DIR}/tests/support/measured ${processor} ${A_TIMEOUT} ${A_COMMAND})
  math(EXPR ended "${A_TIMEOUT} + 60")  # `measured` ends it, and needs time to print the stacks of what hangs
  set_tests_properties(${name} PROPERTIES LABELS "${labels}" TIMEOUT ${ended}
                       ENVIRONMENT_MODIFICATION "PATH=path_list_prepend:${SUITE_TEST_PATH}")
  if(DEFINED SUITE_COST_${name})
    set_tests_properties(${name} PROPERTIES COST ${SUITE_COST_${name}})
  endif()
  if(A_PASS)
    set_tests_properties(${name} PROPERTIES PASS_REGULAR_EXPRESSION "${A_PASS}")
  endif()
  if(A_ENVIRONMENT)
    set_tests_properties(${name} PROPERTIES ENVIRONMENT "${A_ENVIRONMENT}")
  endif()
  set_property(GLOBAL APPEND PROPERTY SUITE_ENTRIES "${name} ${A_LABEL}")
endfunction()

# Adds a source of tests to a GoogleTest program, which its first source makes.
function(_suite_test_program program source libraries)
  if(NOT TARGET ${program})
    add_executable(${program})
    target_link_libraries(${program} PRIVATE suite_flags test_support test_main)
    # Tests are half of all that is compiled, and what they spend their time in are the libraries: -O1 halves their share.
    target_compile_options(${program} PRIVATE $<$<CONFIG:Release>:-O1>)
    set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  endif()
  target_sources(${program} PRIVATE ${source})
  target_link_libraries(${program} PRIVATE ${libraries})
endfunction()

# suite_test(<library>/<subject> USES ... VENDOR ... [ENVIRONMENT ...]): the tests of <library>/<subject>_test.cpp beside the
# CMakeLists as one ctest entry. The tests of a library are one program, <label>_<library>, and those of all formats are
# <label>_formats; the entry runs one source of it (test_main's --source). Sources of a program are compiled in batches
# (CMAKE_UNITY_BUILD), for two thirds of a test's compile time are headers: so each has a namespace of its own, named like its file.
function(_suite_program_of place label program)
  get_filename_component(library ${place} DIRECTORY)
  if(library MATCHES "^format_")
    set(library formats)
  endif()
  set(${program} ${label}_${library} PARENT_SCOPE)
endfunction()
function(suite_test place)
  cmake_parse_arguments(A "" "" "USES;VENDOR;ENVIRONMENT" ${ARGN})
  _suite_test_name(${place} name label)
  _suite_program_of(${place} ${label} program)
  _suite_test_program(${program} ${place}_test.cpp "${A_USES};${A_VENDOR}")
  suite_entry(${name} COMMAND $<TARGET_FILE:${program}> --source=${label}/${place}_test.cpp ENVIRONMENT "${SUITE_SUPPRESSIONS}" ${A_ENVIRONMENT})
  if("${name}" IN_LIST SUITE_QUICK)
    set_property(GLOBAL APPEND PROPERTY SUITE_QUICK_PROGRAMS ${program})
  endif()
endfunction()

# suite_test_long(<library>/<subject> SECONDS s ENVIRONMENT ...): the same tests beyond the default run, entry <name>_long.
function(suite_test_long place)
  cmake_parse_arguments(A "" "SECONDS" "ENVIRONMENT" ${ARGN})
  _suite_test_name(${place} name label)
  _suite_program_of(${place} ${label} program)
  suite_entry(${name}_long LABEL long TIMEOUT ${A_SECONDS} COMMAND $<TARGET_FILE:${program}> --source=${label}/${place}_test.cpp
              ENVIRONMENT "${SUITE_SUPPRESSIONS}" ${A_ENVIRONMENT})
endfunction()

# suite_fuzz(<library>/<subject> USES ... VENDOR ...): seeded mutations over a reader: 1000 an input in the default run,
# 20 000 under the label `long`; tests/fuzz/run says how many it wants.
function(suite_fuzz place)
  suite_test(${place} ${ARGN})
  suite_test_long(${place} SECONDS 1500 ENVIRONMENT SUITE_FUZZ_COUNT=20000)
endfunction()
