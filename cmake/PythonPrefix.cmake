# Sets OUT to the first folder SUBPATH found beside the Python packages (cmeel wheels install below cmeel.prefix there).
function(find_in_python_packages OUT SUBPATH)
  execute_process(
    COMMAND "${Python_EXECUTABLE}" -c
      "import pathlib,sys; print(next((str(pathlib.Path(p,'${SUBPATH}')) for p in sys.path if pathlib.Path(p,'${SUBPATH}').exists()),''))"
    OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  file(TO_CMAKE_PATH "${found}" found)
  set(${OUT} "${found}" PARENT_SCOPE)
endfunction()
