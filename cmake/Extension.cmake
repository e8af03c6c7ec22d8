# The core as a module of Python, with its types.
find_package(Python 3.11 REQUIRED COMPONENTS Interpreter Development.Module)
execute_process(COMMAND "${Python_EXECUTABLE}" -m nanobind --cmake_dir
  OUTPUT_VARIABLE nanobind_ROOT OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
find_package(nanobind CONFIG REQUIRED)

file(GLOB binding_sources CONFIGURE_DEPENDS bindings/*.cpp)
nanobind_add_module(_core NB_STATIC NOMINSIZE NOSTRIP ${binding_sources}) # wheels are stripped when they are installed
target_link_libraries(_core PRIVATE ringlet_core)
if(RINGLET_UNITY)
  set_target_properties(_core nanobind-static PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
endif()
install(TARGETS _core LIBRARY DESTINATION ringlet)
if(SKBUILD AND NOT CMAKE_CROSSCOMPILING) # its types, for editors and type checkers; the module must run for them
  nanobind_add_stub(_core_stub MODULE _core OUTPUT _core.pyi PYTHON_PATH $<TARGET_FILE_DIR:_core> DEPENDS _core)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/_core.pyi" DESTINATION ringlet)
endif()
