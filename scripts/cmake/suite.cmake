# The house rules of the build: one function per kind of target, and a configuration that fails when a library looks
# up or to its right. The order below is the drawing in README.md read row by row from the ground, left to right.
set(SUITE_ORDER base math page  spectral motion sqt sqt_fit  optics water air thermal scene mesh  sensor trace surface light estimate transport scheduler heat cluster study)
set(SUITE_ROW_OF_base 0)
set(SUITE_ROW_OF_math 0)
set(SUITE_ROW_OF_page 0)
foreach(lib spectral motion sqt sqt_fit)
  set(SUITE_ROW_OF_${lib} 1)
endforeach()
foreach(lib optics water air thermal scene mesh)
  set(SUITE_ROW_OF_${lib} 2)
endforeach()
foreach(lib sensor trace surface light estimate transport scheduler heat cluster study)
  set(SUITE_ROW_OF_${lib} 3)
endforeach()

# Flags every target of ours is built with; vendors' headers are system headers and stay out of the warnings.
add_library(suite_flags INTERFACE)
target_compile_features(suite_flags INTERFACE cxx_std_20)
# -Wrestrict of g++ 12 reports overlaps in std::string that cannot happen (GCC bug 105329).
target_compile_options(suite_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Werror -Wno-restrict
                                             -ffp-contract=off -march=${SUITE_ARCH})
target_include_directories(suite_flags INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/libs)
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

# What the leak sanitizer must not count: leaks of libraries that are not ours.
set(SUITE_LEAKS "LSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/fuzz/leaks_of_libraries.txt:print_suppressions=0")

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

# suite_test(<library>/<subject> USES ... VENDOR ... TIMEOUT s): the GoogleTest executable of <library>/<subject>_test.cpp
# beside the CMakeLists; its label is the folder's name, one ctest entry per executable.
function(suite_test place)
  cmake_parse_arguments(A "" "TIMEOUT" "USES;VENDOR" ${ARGN})
  _suite_test_name(${place} name label)
  add_executable(${name} ${place}_test.cpp)
  target_link_libraries(${name} PRIVATE suite_flags test_support ${A_USES} ${A_VENDOR} GTest::gtest GTest::gmock GTest::gtest_main)
  # Tests are half of all that is compiled, and what they spend their time in are the libraries: -O1 halves their share.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  add_test(NAME ${name} COMMAND ${name})
  # A test that hangs is to be ended, one on a busy machine not: the slowest take a minute of CPU.
  if(NOT A_TIMEOUT)
    set(A_TIMEOUT 1500)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS ${label} TIMEOUT ${A_TIMEOUT} ENVIRONMENT "${SUITE_LEAKS}")
endfunction()

# suite_fuzz(<library>/<subject> USES ... VENDOR ...): seeded mutations over a reader: some 20 000 (seconds) in the default
# run, and a campaign of 30 s per input under the label `long`.
function(suite_fuzz place)
  suite_test(${place} ${ARGN})
  _suite_test_name(${place} name label)
  add_test(NAME ${name}_long COMMAND ${name})
  set_tests_properties(${name}_long PROPERTIES LABELS "long" TIMEOUT 1500 ENVIRONMENT "SUITE_FUZZ_SECONDS=30;${SUITE_LEAKS}")
endfunction()
