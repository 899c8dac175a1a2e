// SPDX-License-Identifier: Apache-2.0
// Loaded before a program (LD_PRELOAD), kills it as kill -9 would just before its Nth call that changes a file or a folder: N is
// PATENCY_KILL_AT. With PATENCY_CALLS_INTO=FILE it writes what they were instead, one a line. So every state that a run can leave on
// the disk is reached by a number, and not by luck.
#include <dlfcn.h>
#include <sys/types.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace {

long calls = 0;

void count_call(const char* name, const char* path) {
    static const char* const wanted = std::getenv("PATENCY_KILL_AT");
    if (++calls == (wanted ? std::atol(wanted) : -1)) ::kill(::getpid(), SIGKILL);
    static const char* const into = std::getenv("PATENCY_CALLS_INTO");
    static std::FILE* const list = into ? std::fopen(into, "w") : nullptr;
    if (list) std::fprintf(list, "%s %s\n", name, path);
}

template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}   // namespace

extern "C" {

int fsync(int file) {
    count_call("fsync", "");
    return next<int(int)>("fsync")(file);
}
int rename(const char* from, const char* to) {
    count_call("rename", to);
    return next<int(const char*, const char*)>("rename")(from, to);
}
int mkdir(const char* path, mode_t mode) {
    count_call("mkdir", path);
    return next<int(const char*, mode_t)>("mkdir")(path, mode);
}
int ftruncate(int file, off_t length) {
    count_call("ftruncate", "");
    return next<int(int, off_t)>("ftruncate")(file, length);
}
int remove(const char* path) {
    count_call("remove", path);
    return next<int(const char*)>("remove")(path);
}
int unlinkat(int folder, const char* path, int flags) {
    count_call("unlinkat", path);
    return next<int(int, const char*, int)>("unlinkat")(folder, path, flags);
}
int fflush(std::FILE* file) {   // of rows in tables
    if (file != stdout && file != stderr) count_call("fflush", "");
    return next<int(std::FILE*)>("fflush")(file);
}

}   // extern "C"
