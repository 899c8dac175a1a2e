// SPDX-License-Identifier: Apache-2.0
#include "patency/report/page.h"

#include <fmt/format.h>

#include "patency/io/atomic_file.h"
#include "patency/report/page_data.h"
#include "patency/report/page_frame.h"
#include "patency/report/page_parts.h"
#include "patency/report/sections.h"

namespace patency {

namespace {

/// JSON within a script element: no text in it can end the element, and it stays the same JSON.
std::string json_block(const std::string& id, const std::string& text) {
    std::string safe;
    for (const char c : text) c == '<' ? safe += "\\u003c" : safe += c;
    return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, safe);
}

const char* subtitle(const RunResults& results) {
    const bool has_before = !results.flows.empty() && results.flows.front().key == "before",
               has_after = !results.flows.empty() && results.flows.back().key == "after";
    return has_before && has_after  ? "Blood flow before and after a stent"
           : results.flows.empty()  ? "The deployment of a stent"
           : results.has_deployment ? "Blood flow and the deployment of a stent"
                                    : "Blood flow";
}

/// Where the script puts the live view; hidden without one.
constexpr std::string_view live_section = "<section id=\"live\" hidden></section>\n";

constexpr std::string_view notes =
    "Every number here is one of summary.json, or a ratio of two.</p>\n"
    "<p>FFR is the mean pressure behind a lesion over the mean aortic pressure, both absolute, at hyperaemia; it is "
    "read 15 mm behind the lesion's end "
    "(10 to 20 mm is usual: Nørgaard et al. 2019). The marks at 0.75 and 0.80 are usual bands, no verdict; after a "
    "stent there is no agreed limit, 0.90 is a usual aim "
    "(FFR-SEARCH 2021). Pressures count from the deck's zero, but for FFR. The gauge pressure ratio is a ratio of "
    "pressures above the lowest outlet's, and no FFR. WSS is the mean wall shear stress vector's length, "
    "TAWSS the mean of its length, OSI = ½ (1 − WSS/TAWSS).";

}   // namespace

std::string make_page(const RunResults& results, std::string_view version) {
    const PageData data = make_page_data(results);
    std::string page = page_head(results.name) + "<body>\n" + page_masthead(results.name, subtitle(results)) +
                       "<main>\n" + glance_section(results) + std::string(live_section) + static_section(results) +
                       beat_section(results) + quality_section(results) + tables_section(results) +
                       run_section(results) + "</main>\n" + page_footer(version, notes);
    page += json_block("summary", results.summary_text) + json_block("model", data.model);
    for (const Blob& blob : data.blobs)
        page += fmt::format("<script type=\"application/octet-stream\" id=\"{}\">{}</script>\n", blob.id, blob.base64);
    return page + "<script>" + std::string(page_script()) + "</script>\n</body>\n</html>\n";
}

std::filesystem::path write_report(const std::filesystem::path& folder, std::string_view version) {
    std::filesystem::path path = folder / "report.html";
    write_file(path, make_page(read_results(folder), version));
    return path;
}

}   // namespace patency
