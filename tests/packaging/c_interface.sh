#!/usr/bin/env bash
# c_interface.sh PREFIX COMPILER FOLDER: builds the example of the installed C interface with pkg-config and with CMake,
# runs it, and imports the installed Python package.
set -euo pipefail
prefix=$1 compiler=$2 folder=$3
rm -rf "$folder" && mkdir -p "$folder" && cd -- "$folder"
library=$(echo "$prefix"/lib*/*/libpkmopt.so "$prefix"/lib*/libpkmopt.so | tr ' ' '\n' | grep -v '\*' | head -n 1)
export LD_LIBRARY_PATH=${library%/*} PKG_CONFIG_PATH=${library%/*}/pkgconfig
read -ra flags <<< "$(pkg-config --cflags --libs pkmopt)"
"$compiler" -std=c99 -Wall -Wextra -Wpedantic -Werror "$prefix/share/doc/pkmopt/example.c" "${flags[@]}" -o example
robot=$prefix/share/pkmopt/experiments/mechanisms/rotary-delta.toml
./example "$robot"

cat > CMakeLists.txt <<< "cmake_minimum_required(VERSION 3.25)
project(example LANGUAGES C)
find_package(pkmopt REQUIRED COMPONENTS c)
add_executable(example $prefix/share/doc/pkmopt/example.c)
target_link_libraries(example pkmopt::c)"
cmake -B build -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_C_COMPILER="$compiler" --log-level=WARNING
cmake --build build > build.log
diff <(./example "$robot") <(build/example "$robot")

PYTHONPATH=$prefix/lib/python3/dist-packages /usr/bin/python3 -c "
import pkmopt
print('Python', pkmopt.version, pkmopt.Mechanism.from_file('$robot').design().workspace())"
