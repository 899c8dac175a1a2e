// SPDX-License-Identifier: Apache-2.0
// `patency` of a package: becomes the program that was compiled for this processor. It computes nothing itself, and so is compiled for
// any.
#include <unistd.h>
#if defined(__x86_64__)
#define _Bool bool   // the header is written for C
#include <sys/platform/x86.h>
#undef _Bool
#endif

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>

#include "instruction_set.h"

namespace {

namespace fs = std::filesystem;

/// Asks the C library, which knows of the operating system too whether it keeps the wide registers.
patency::chooser::Processor this_processor() {
#if defined(__x86_64__)
    return {.bears_avx2 = CPU_FEATURE_ACTIVE(AVX) && CPU_FEATURE_ACTIVE(AVX2) && CPU_FEATURE_ACTIVE(BMI1) &&
                          CPU_FEATURE_ACTIVE(BMI2) && CPU_FEATURE_ACTIVE(F16C) && CPU_FEATURE_ACTIVE(FMA) &&
                          CPU_FEATURE_ACTIVE(LZCNT) && CPU_FEATURE_ACTIVE(MOVBE),
            .bears_avx512 = CPU_FEATURE_ACTIVE(AVX512F) && CPU_FEATURE_ACTIVE(AVX512BW) &&
                            CPU_FEATURE_ACTIVE(AVX512CD) && CPU_FEATURE_ACTIVE(AVX512DQ) &&
                            CPU_FEATURE_ACTIVE(AVX512VL)};
#else
    return {};
#endif
}

/// Returns only by throwing.
[[noreturn]] void become_program(char** argv) {
    const char* wanted = std::getenv("PATENCY_ISA");
    const std::string set = patency::chooser::choose_set(this_processor(), wanted != nullptr ? wanted : "");
    const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
    const fs::path program = (here / PATENCY_PROGRAMS / ("patency-" + set)).lexically_normal();
    ::execv(program.c_str(), argv);
    throw patency::FileError("cannot start '" + program.string() + "': " + std::strerror(errno) +
                             "; is patency installed as a whole?");
}

}   // namespace

int main(int, char** argv) {
    try {
        become_program(argv);
    } catch (const patency::Error& error) {
        std::fprintf(stderr, "patency: %s\n", error.what());
        return int(error.code());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "patency: %s\n", error.what());
        return 1;
    }
}
