// SPDX-License-Identifier: Apache-2.0
// What every page has around its sections.
#pragma once

#include <string>
#include <string_view>

namespace patency {

/// Up to </head>: policy, title, style. Nothing may be fetched, sent or framed; only the page's own script and style run.
std::string page_head(const std::string& title);
/// `subtitle` is HTML.
std::string page_masthead(const std::string& title, const std::string& subtitle);
/// `notes` is HTML, behind the program's version.
std::string page_footer(std::string_view version, std::string_view notes);

}   // namespace patency
