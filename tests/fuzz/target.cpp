// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/target.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <utility>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/io/network_file.h"
#include "patency/io/surface_file.h"
#include "patency/shape/network_lumen.h"
#include "patency/stages/vessel.h"

namespace patency {

namespace {

namespace fs = std::filesystem;

void expect(bool law, const std::string& what) {
    if (!law) throw BrokenLaw(what);
}

/// What was read and written is read again: the same deck.
void use_deck(const std::string& text, const fs::path& folder) {
    for (const deck::NamedCase& named : deck::parse_runs(text, "deck", folder)) {
        const std::string written = deck::format_case(named.resolved, folder);
        std::string again;
        try {
            again = deck::format_case(deck::parse_case(written, "written", folder), folder);
        } catch (const Error& error) {
            throw BrokenLaw(
                fmt::format("an accepted deck is refused when it is written and read again: {}", error.what()));
        }
        expect(again == written, "an accepted deck changes when it is written and read again");
    }
}

/// Whether a place is there or beside it, where the middle of a bent line may be.
bool is_near(const Bounds& box, const Vec3& x) {
    const double slack = 0.5 * diagonal(box);
    return x.x >= box.low.x - slack && x.x <= box.high.x + slack && x.y >= box.low.y - slack &&
           x.y <= box.high.y + slack && x.z >= box.low.z - slack && x.z <= box.high.z + slack;
}

/// What is said of a surface lies where the surface is.
void expect_sound(const Vessel& vessel, const Bounds& box) {
    expect(std::isfinite(vessel.checked.volume), "the volume is no number");
    for (const Finding& finding : vessel.checked.findings) {
        expect(!finding.sentence.empty(), "a finding without a sentence");
        if (finding.kind == "missing_openings") continue;   // what is missing has no place
        expect(is_near(box, finding.place),
               fmt::format("a finding beside the surface: {} at ({:g}, {:g}, {:g}) m", finding.kind, finding.place.x,
                           finding.place.y, finding.place.z));
        expect(finding.size <= 4 * diagonal(box),
               "a finding larger than the surface");   // of a bent line, by its farthest point
    }
    for (const SurfaceOpening& o : vessel.openings) {
        expect(o.opening.area > 0 && std::isfinite(o.opening.area), "an opening without area");
        expect(is_near(box, o.opening.centre), "an opening beside the surface");
    }
    if (!vessel.along) return;
    for (const Centreline& line : vessel.along->lines.lines)
        expect(std::isfinite(line.length()) && line.length() > 0, "a centreline without length");
}

/// Squares as wide as the narrowest tube on the wall, at most: how much there is to compute.
double fineness_of(const Network& network) {
    double length = 0;
    for (const Tube& tube : network.tubes) length += length_of(tube);
    return length * widest_diameter(network) / std::pow(narrowest_diameter(network), 2);
}

void use_vessel(const fs::path& path) {
    Vessel vessel;
    Bounds box;
    if (holds_network(path)) {
        const Network network = read_network(path, "mm");
        openings_of(network, 1e-3);
        if (fineness_of(network) > 100) return;   // sound perhaps, but seconds of computing
        vessel = check_vessel(network);
        box = bounds(vessel.checked.surface);
    } else {
        Surface surface = read_surface(path, "mm");
        box = bounds(surface);
        vessel = check_vessel(std::move(surface));
    }
    follow_vessel(vessel);
    expect_sound(vessel, box);
    if (!vessel.openings.empty()) expect_vessel_size(vessel.openings[0], "mm");
    if (const std::string why = refusals(vessel.checked.findings); !why.empty()) throw GeometryError(why);
}

}   // namespace

void use_file(const fs::path& path, const std::string& contents) {
    if (path.extension() == ".yaml") return use_deck(contents, path.parent_path());
    std::ofstream(path, std::ios::binary) << contents;
    use_vessel(path);
}

Ending end_of(const fs::path& path, const std::string& contents, std::string& sentence) {
    sentence.clear();
    constexpr std::size_t shortest_sentence = 20;   // letters
    try {
        use_file(path, contents);
        return Ending::accepted;
    } catch (const Error& error) {
        sentence = error.what();
        if (sentence.size() >= shortest_sentence) switch (error.code()) {
                case ExitCode::usage: return Ending::usage;
                case ExitCode::deck: return Ending::deck;
                case ExitCode::geometry: return Ending::geometry;
                case ExitCode::file_system: return Ending::file;
                default: break;   // no other error is one of a file
            }
        sentence = fmt::format("an error with the code {} that does not fit: {}", int(error.code()), sentence);
    } catch (const std::exception& error) {
        sentence = fmt::format("not an error of the project's: {}", error.what());
    }
    return Ending::found;
}

}   // namespace patency

/// For libFuzzer, which asks for this name. PATENCY_FUZZ_KIND is the extension of the file that the bytes are: stl if not set.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    namespace fs = std::filesystem;
    const char* kind = std::getenv("PATENCY_FUZZ_KIND");
    static const fs::path path =
        fs::temp_directory_path() / fmt::format("patency_fuzz_{}.{}", ::getpid(), kind ? kind : "stl");
    std::string sentence;
    if (patency::end_of(path, {reinterpret_cast<const char*>(bytes), size}, sentence) == patency::Ending::found) {
        fmt::print(stderr, "{}\n", sentence);
        std::abort();   // which libFuzzer takes for a crash
    }
    return 0;
}
