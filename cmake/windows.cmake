# Cross-builds for Windows with zig, so with Clang and libc++: see tools/windows.sh.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR AMD64)
set(CMAKE_CXX_COMPILER zig c++ -target x86_64-windows-gnu)
