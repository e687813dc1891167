# The compiler cache is used where there is one; whoever builds Maximin as a part of something else decides for himself.
if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(MAXIMIN_CCACHE ccache)
  mark_as_advanced(MAXIMIN_CCACHE)
  if(MAXIMIN_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${MAXIMIN_CCACHE})
  endif()
endif()

# One include form everywhere: <maximin/FLOOR/NAME.hpp>. In the build tree it is a folder of links to the floors.
set(MAXIMIN_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${MAXIMIN_INCLUDE_DIR}/maximin)

# What every target of the project is compiled with. Results are certified, so no contraction and never -ffast-math.
add_library(maximin_options INTERFACE)
target_compile_features(maximin_options INTERFACE cxx_std_20)
target_compile_options(maximin_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor
  $<$<BOOL:${MAXIMIN_WARNINGS_AS_ERRORS}>:-Werror>
  # g++ 12 sees overlapping copies in std::string::operator+ where there are none (its bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # In a unit of several sources g++ takes each of them for a header, and its unnamed namespace for an accident.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>)
if(MAXIMIN_SANITIZE)
  target_compile_options(maximin_options INTERFACE -fsanitize=${MAXIMIN_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(maximin_options INTERFACE -fsanitize=${MAXIMIN_SANITIZE})
  if(MAXIMIN_SANITIZE MATCHES "address.*undefined")
    # What these two see the address sanitizer sees as well, and without them the build takes two thirds of the time.
    target_compile_options(maximin_options INTERFACE -fno-sanitize=null,object-size)
  endif()
endif()

# maximin_package(NAME VERSION [argument...]): find_package, and the version remembered for who links the installed tree.
macro(maximin_package name version)
  find_package(${name} ${version} REQUIRED ${ARGN})
  set_property(GLOBAL PROPERTY MAXIMIN_PACKAGE_${name} "${version}")
endmacro()

# maximin_floor(NAME [FOLDER folder] [SOURCES file...] [LINK target...] [PACKAGES package...]): the library maximin::NAME
# of the folder NAME, or of one further down whose headers are reached through the folder above it. PACKAGES names what
# it needs that LINK does not tell.
# Without sources it is header-only. What it links is public; PACKAGE::target in LINK makes PACKAGE a dependency of the
# installed floor, maximin::FLOOR makes that floor one.
function(maximin_floor name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "FOLDER" "SOURCES;LINK;PACKAGES")
  set(target maximin_${name})
  if(arg_SOURCES)
    add_library(${target} STATIC ${arg_SOURCES})
    target_link_libraries(${target} PUBLIC ${arg_LINK} PRIVATE $<BUILD_INTERFACE:maximin_options>)
    set(scope PUBLIC)
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${arg_LINK})
    set(scope INTERFACE)
  endif()
  add_library(maximin::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} ${scope} cxx_std_20)
  target_compile_options(${target} ${scope} $<$<CXX_COMPILER_ID:GNU,Clang>:-ffp-contract=off>)
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${MAXIMIN_INCLUDE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  if(NOT arg_FOLDER)
    set(arg_FOLDER ${name})
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${MAXIMIN_INCLUDE_DIR}/maximin/${name} SYMBOLIC)
  endif()
  set_property(GLOBAL PROPERTY MAXIMIN_FOLDER_${name} ${arg_FOLDER})
  set_property(GLOBAL PROPERTY MAXIMIN_PACKAGES_${name} "${arg_PACKAGES}")
  set_property(GLOBAL APPEND PROPERTY MAXIMIN_FLOORS ${name})
  set_property(GLOBAL PROPERTY MAXIMIN_LINK_${name} "${arg_LINK}")
endfunction()
