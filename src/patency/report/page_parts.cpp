// SPDX-License-Identifier: Apache-2.0
// The assembler puts the files into the object: no compiler has to read them as text.
#include "patency/report/page_parts.h"

#define PATENCY_EMBED(name, file)                                                                  \
    __asm__(".pushsection .rodata\n" #name "_begin: .incbin \"" PATENCY_PAGE "/" file "\"\n" #name \
            "_end:\n.popsection\n");                                                               \
    extern "C" const char name##_begin[] __attribute__((visibility("hidden")));                    \
    extern "C" const char name##_end[] __attribute__((visibility("hidden")));

PATENCY_EMBED(patency_page_script, "page.js")
PATENCY_EMBED(patency_page_script_hash, "page.js.hash")
PATENCY_EMBED(patency_page_style, "style.css")
PATENCY_EMBED(patency_page_style_hash, "style.css.hash")

namespace patency {

std::string_view page_script() { return {patency_page_script_begin, patency_page_script_end}; }
std::string_view page_script_hash() { return {patency_page_script_hash_begin, patency_page_script_hash_end}; }
std::string_view page_style() { return {patency_page_style_begin, patency_page_style_end}; }
std::string_view page_style_hash() { return {patency_page_style_hash_begin, patency_page_style_hash_end}; }

}   // namespace patency
