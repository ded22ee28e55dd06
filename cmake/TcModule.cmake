# tc_module(NAME SOURCES…): one room of the library, an object library tc_NAME. libtetcast is made of all rooms;
# a unit test links only those it names.
add_library(tc_flags INTERFACE)
target_include_directories(tc_flags INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
target_compile_options(tc_flags INTERFACE -Wall -Wextra -Wshadow -Wvla
  $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes -Wmissing-prototypes -Wpointer-arith>
  $<$<BOOL:${TC_WERROR}>:-Werror>
  -fno-math-errno)
if(TC_SANITIZE)
  target_compile_options(tc_flags INTERFACE -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(tc_flags INTERFACE -fsanitize=address,undefined)
endif()

function(tc_module NAME)
  add_library(tc_${NAME} OBJECT ${ARGN})
  target_link_libraries(tc_${NAME} PRIVATE tc_flags PkgConfig::JANSSON Threads::Threads)
  set_property(GLOBAL APPEND PROPERTY TC_MODULES tc_${NAME})
endfunction()
