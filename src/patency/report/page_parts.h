// SPDX-License-Identifier: Apache-2.0
// What web/ was bundled into, as it stands in the program. The hashes are for the content-security policy: "sha256-...".
#pragma once

#include <string_view>

namespace patency {

std::string_view page_script();
std::string_view page_script_hash();
std::string_view page_style();
std::string_view page_style_hash();

}   // namespace patency
