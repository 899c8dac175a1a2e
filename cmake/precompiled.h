// SPDX-License-Identifier: Apache-2.0
// The parts of the standard library that nearly every file includes, and the instructions of packs: read once per way of compiling
// (compiling.cmake) instead of in each file. No file relies on it: the debug preset and tools/check_headers compile without.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>
#if defined(__x86_64__)
#include <immintrin.h>
#endif
