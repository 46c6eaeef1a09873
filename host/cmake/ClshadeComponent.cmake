# One component of the library per folder of host/: a static library clshade_<name> with the alias clshade::<name>,
# made of the folder's *.cpp, seeing only the headers of the components it links.

set(CLSHADE_COMPONENTS "" CACHE INTERNAL "")

add_library(clshade_warnings INTERFACE)
target_compile_options(clshade_warnings INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-align
  -Woverloaded-virtual -Wnull-dereference -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough>
  $<$<BOOL:${CLSHADE_WARNINGS_AS_ERRORS}>:-Werror>)

# clshade_component(NAME [PUBLIC libs...] [PRIVATE libs...])
function(clshade_component name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_library(clshade_${name} STATIC ${sources})
  add_library(clshade::${name} ALIAS clshade_${name})
  set_target_properties(clshade_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(clshade_${name} PUBLIC cxx_std_20)
  target_include_directories(clshade_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/clshade>)
  target_link_libraries(clshade_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:clshade_warnings>)
  set(CLSHADE_COMPONENTS ${CLSHADE_COMPONENTS} ${name} CACHE INTERNAL "")
endfunction()
