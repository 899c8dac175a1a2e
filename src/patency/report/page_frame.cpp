// SPDX-License-Identifier: Apache-2.0
#include "patency/report/page_frame.h"

#include <fmt/format.h>

#include "patency/report/figures.h"
#include "patency/report/page_parts.h"

namespace patency {

std::string page_head(const std::string& title) {
    const std::string policy = fmt::format(
        "default-src 'none'; script-src '{}'; style-src '{}'; img-src data: blob:; base-uri 'none'; form-action 'none'",
        page_script_hash(), page_style_hash());
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta "
        "http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" "
        "content=\"light dark\">\n"
        "<meta name=\"referrer\" content=\"no-referrer\">\n<link rel=\"icon\" href=\"data:,\">\n"
        "<title>{} – patency</title>\n<style>{}</style>\n</head>\n",
        policy, escaped(title), page_style());
}

std::string page_masthead(const std::string& title, const std::string& subtitle) {
    return fmt::format(
        "<header class=\"masthead\"><p class=\"brand\">patency</p><div><h1>{}</h1><p class=\"subtitle\">{}</p></div>"
        "<p class=\"research\">Research use only</p></header>\n",
        escaped(title), subtitle);
}

std::string page_footer(std::string_view version, std::string_view notes) {
    return fmt::format(
        "<footer><p><b>Research use only.</b> Not a medical device: no basis for treating a patient.</p>\n<p>Made by "
        "patency {}. {}</p>\n"
        "<div id=\"licences\"></div></footer>\n",
        escaped(version), notes);
}

}   // namespace patency
