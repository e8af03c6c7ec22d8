# Cross-builds for Windows with zig's Clang and libc++, and runs what was built with Wine: see tools/windows.sh.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR AMD64)
set(CMAKE_CXX_COMPILER zig c++ -target x86_64-windows-gnu)
set(CMAKE_AR zig ar)
set(CMAKE_CROSSCOMPILING_EMULATOR wine)
