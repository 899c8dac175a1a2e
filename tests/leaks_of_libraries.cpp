// SPDX-License-Identifier: Apache-2.0
// What the leak sanitizer keeps to itself: memory that a library loses, not the program. VTK 9.1 loses some when a file that it
// reads is damaged.

extern "C" const char* __lsan_default_suppressions() { return "leak:libvtk"; }
