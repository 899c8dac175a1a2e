// SPDX-License-Identifier: Apache-2.0
// patency inspect: what a surface is as a vessel. A table on the terminal; with -o the cleaned surface, what was found
// wrong with it, figures and a picture.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "command_line.h"
#include "commands.h"
#include "patency/base/units.h"
#include "patency/io/atomic_file.h"
#include "patency/io/centreline_file.h"
#include "patency/io/network_file.h"
#include "patency/io/output_folder.h"
#include "patency/io/summary.h"
#include "patency/io/surface_file.h"
#include "patency/io/surface_picture.h"
#include "patency/io/vtp.h"
#include "patency/stages/vessel.h"

namespace patency::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct InspectOptions {
    std::string path, unit, space, out, inlet;
    std::optional<int> label;
};

struct Inspection : Vessel {
    double wall_area() const {   // what closes an end is no wall
        double sum = area(checked.surface);
        for (const SurfaceOpening& opening : openings)
            if (!opening.triangles.empty()) sum -= opening.opening.area;
        return sum;
    }
};

Inspection inspect(const InspectOptions& o) {
    if (!holds_network(o.path)) {
        Inspection result{check_vessel(read_surface(o.path, o.unit, o.space, o.label), o.inlet)};
        follow_vessel(result);
        return result;
    }
    const Network network = read_network(o.path, o.unit, o.space);
    Inspection result{check_vessel(network, o.inlet)};
    follow_vessel(result);
    name_as_tubes(result, network);
    return result;
}

std::string diameter_of(const std::optional<Reference>& reference) {
    return reference ? fmt::format("{:.3f}", 1e3 * reference->diameter) : "none";
}

void print_along(const VesselAlong& v) {
    fmt::print("Centrelines from the inlet, diameters of the largest spheres that fit:\n");
    for (const Centreline& line : v.lines.lines)
        fmt::print("  {:<12} {:>9.2f} mm long\n", line.outlet, 1e3 * line.length());
    fmt::print("Branches:\n    {:<12} {:<12} {:>9} {:>9} {:>24}\n", "name", "after", "from mm", "to mm",
               "diameter mm, mean, range");
    for (const Branch& b : v.lines.branches) {
        const Widths w = widths_of(v, b);
        fmt::print("    {:<12} {:<12} {:>9.2f} {:>9.2f} {:>9.3f} {:>6.3f} to {:.3f}\n", b.name,
                   b.parent < 0 ? "inlet" : v.lines.branches[std::size_t(b.parent)].name, 1e3 * v.lines.start_arc(b),
                   1e3 * v.lines.end_arc(b), 1e3 * w.mean, 1e3 * w.least, 1e3 * w.most);
    }
    fmt::print("Lesions: {}\n", v.assessment.lesions.empty() ? "none" : "");
    for (std::size_t k = 0; k < v.assessment.lesions.size(); ++k) {
        const Lesion& l = v.assessment.lesions[k];
        const Vec3 c = 1e3 * l.place;
        fmt::print("  L{} in {} at {:.2f} mm ({:.2f} to {:.2f}), ({:.2f}, {:.2f}, {:.2f}) mm\n", k + 1,
                   v.lines.branches[l.branch].name, 1e3 * l.throat_arc, 1e3 * l.start_arc, 1e3 * l.end_arc, c.x, c.y,
                   c.z);
        fmt::print("     stenosis {:.1f} % of the diameter, {:.1f} % of the area; {:.3f} mm, {:.3f} mm^2 at least\n",
                   100 * l.diameter_stenosis, 100 * l.area_stenosis, 1e3 * l.minimum_diameter, 1e6 * l.minimum_area);
        fmt::print("     reference diameters mm: proximal {}, distal {}, interpolated {:.3f}\n",
                   diameter_of(l.proximal), diameter_of(l.distal), 1e3 * l.interpolated.diameter);
    }
}

void print_table(const InspectOptions& o, const Inspection& r) {
    const Surface& surface = r.checked.surface;
    const Bounds box = bounds(surface);
    fmt::print("{} (unit {}{})\n", o.path, o.unit.empty() ? "its own" : o.unit,
               surface.space.empty() ? "" : ", axes " + surface.space);
    fmt::print("  triangles   {} read, {} kept; {} points\n", r.triangles_read, surface.triangles.size(),
               surface.points.size());
    for (const auto& [axis, low, high] :
         {std::tuple("x", box.low.x, box.high.x), {"y", box.low.y, box.high.y}, {"z", box.low.z, box.high.z}})
        fmt::print("  {}           {:.3f} to {:.3f} mm\n", axis, 1e3 * low, 1e3 * high);
    fmt::print("  wall area   {:.5g} mm^2\n  volume      {:.5g} mm^3\n", 1e6 * r.wall_area(), 1e9 * r.checked.volume);
    fmt::print("Findings: {}\n", r.checked.findings.empty() ? "none" : "");
    for (const Finding& finding : r.checked.findings)
        fmt::print("  {:<9} {:<20} {}\n", word_of(finding.verdict), finding.kind, finding.sentence);
    fmt::print("Openings: {}\n", r.openings.empty() ? "none" : "");
    if (!r.openings.empty())
        fmt::print("   # {:<11} {:>11} {:>11} {:>32}   {:<24} {:>10}  {}\n", "name", "diameter mm", "area mm^2",
                   "centre mm", "outward normal", "off square", "face");
    for (std::size_t k = 0; k < r.openings.size(); ++k) {
        const Opening& opening = r.openings[k].opening;
        const Vec3 c = 1e3 * opening.centre, n = opening.normal;
        const std::optional<double> angle = off_square(r, k);
        fmt::print(
            "  {:>2} {:<11} {:>11.3f} {:>11.4g} {:>10.3f} {:>10.3f} {:>10.3f}   {:>7.3f} {:>7.3f} {:>7.3f}  {:>10}  "
            "{}\n",
            k + 1, opening.name, 2e3 * opening.radius, 1e6 * opening.area, c.x, c.y, c.z, n.x, n.y, n.z,
            angle ? fmt::format("{:.1f} deg", in_unit(*angle, "deg")) : "unknown",
            r.openings[k].face_id             ? std::to_string(*r.openings[k].face_id)
            : r.openings[k].triangles.empty() ? "open"
                                              : "flat");
    }
    if (r.along) print_along(*r.along);
}

Json scaled(const Vec3& x, double factor) { return {factor * x.x, factor * x.y, factor * x.z}; }

Json as_json(const std::optional<Reference>& reference) {
    if (!reference) return {};
    return {{"diameter_mm", 1e3 * reference->diameter}, {"area_mm2", 1e6 * reference->area}};
}

void add_along(Json& json, const VesselAlong& v) {
    json["centrelines"] = Json::object();
    for (const Centreline& line : v.lines.lines)
        json["centrelines"][line.outlet] = {{"length_mm", 1e3 * line.length()}, {"points", line.points.size()}};
    json["branches"] = Json::object();
    for (const Branch& b : v.lines.branches) {
        const Widths w = widths_of(v, b);
        Json outlets = Json::array();
        for (std::size_t j : b.lines) outlets.push_back(v.lines.lines[j].outlet);
        json["branches"][b.name] = {
            {"parent", b.parent < 0 ? Json() : Json(v.lines.branches[std::size_t(b.parent)].name)},
            {"outlets", outlets},
            {"start_arc_mm", 1e3 * v.lines.start_arc(b)},
            {"end_arc_mm", 1e3 * v.lines.end_arc(b)},
            {"minimum_diameter_mm", 1e3 * w.least},
            {"mean_diameter_mm", 1e3 * w.mean},
            {"maximum_diameter_mm", 1e3 * w.most}};
    }
    json["lesions"] = Json::array();
    for (const Lesion& l : v.assessment.lesions)
        json["lesions"].push_back({{"branch", v.lines.branches[l.branch].name},
                                   {"line", v.lines.lines[l.line].outlet},
                                   {"start_arc_mm", 1e3 * l.start_arc},
                                   {"throat_arc_mm", 1e3 * l.throat_arc},
                                   {"end_arc_mm", 1e3 * l.end_arc},
                                   {"length_mm", 1e3 * l.length()},
                                   {"place_mm", scaled(l.place, 1e3)},
                                   {"minimum_diameter_mm", 1e3 * l.minimum_diameter},
                                   {"minimum_area_mm2", 1e6 * l.minimum_area},
                                   {"proximal_reference", as_json(l.proximal)},
                                   {"distal_reference", as_json(l.distal)},
                                   {"interpolated_reference", as_json(std::optional(l.interpolated))},
                                   {"diameter_stenosis_percent", 100 * l.diameter_stenosis},
                                   {"area_stenosis_percent", 100 * l.area_stenosis}});
}

Json as_json(const InspectOptions& o, const Inspection& r) {
    const Surface& surface = r.checked.surface;
    const Bounds box = bounds(surface);
    Json json{{"file", fs::path(o.path).filename().string()},
              {"unit", o.unit.empty() ? Json() : Json(o.unit)},
              {"space", surface.space.empty() ? Json() : Json(surface.space)}};
    json["triangles_read"] = r.triangles_read;
    json["triangles"] = surface.triangles.size();
    json["points"] = surface.points.size();
    json["low_mm"] = scaled(box.low, 1e3);
    json["high_mm"] = scaled(box.high, 1e3);
    json["wall_area_mm2"] = 1e6 * r.wall_area();
    json["volume_mm3"] = 1e9 * r.checked.volume;
    json["usable"] = refusals(r.checked.findings).empty();
    json["findings"] = Json::array();
    for (const Finding& f : r.checked.findings)
        json["findings"].push_back({{"kind", f.kind},
                                    {"verdict", word_of(f.verdict)},
                                    {"count", f.count},
                                    {"place_mm", scaled(f.place, 1e3)},
                                    {"size_mm", 1e3 * f.size},
                                    {"sentence", f.sentence}});
    json["openings"] = Json::object();
    for (const SurfaceOpening& opening : r.openings) {
        const std::optional<double> angle = off_square(r, json["openings"].size());
        json["openings"][opening.opening.name] = {{"diameter_mm", 2e3 * opening.opening.radius},
                                                  {"area_mm2", 1e6 * opening.opening.area},
                                                  {"perimeter_mm", 1e3 * opening.perimeter},
                                                  {"flatness_error_mm", 1e3 * opening.flatness},
                                                  {"centre_mm", scaled(opening.opening.centre, 1e3)},
                                                  {"normal", scaled(opening.opening.normal, 1)},
                                                  {"off_square_deg", angle ? Json(in_unit(*angle, "deg")) : Json()},
                                                  {"model_face_id", opening.face_id ? Json(*opening.face_id) : Json()}};
    }
    if (r.along) add_along(json, *r.along);
    return json;
}

void write_results(const InspectOptions& o, const Inspection& r) {
    const OutputFolder folder(o.out);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.root()))   // of an earlier surface
        if (entry.path().filename().string().starts_with("finding_") || entry.path().filename() == "centerline.vtp")
            fs::remove(entry.path());
    write_surface(folder.file("surface.vtp"), r.checked.surface);
    for (const Finding& f : r.checked.findings)
        if (!f.shown.points.empty())
            write_polydata(
                folder.file(fmt::format("finding_{}.vtp", f.kind)),
                {.points = f.shown.points, .lines = f.lines, .triangles = f.shown.triangles, .space = f.shown.space});
    write_summary(folder.file("inspect.json"), as_json(o, r));
    DrawnLines drawn;
    if (r.along) {
        const VesselAlong& v = *r.along;
        write_centrelines(folder.file("centerline.vtp"), v.lines, v.sections, v.assessment, r.checked.surface.space);
        for (const Centreline& line : v.lines.lines) {
            drawn.lines.emplace_back();
            for (const CentrelinePoint& p : line.points) drawn.lines.back().push_back(p.place);
        }
        for (const Lesion& l : v.assessment.lesions)
            drawn.marks.push_back({l.place, fmt::format("{:.0f} %", 100 * l.diameter_stenosis)});
    }
    write_file(folder.file("inspect.svg"),
               draw_surface(r.checked.surface, r.openings, fs::path(o.path).filename().string(), drawn));
}

void run(const InspectOptions& o) {
    const Inspection result = inspect(o);
    print_table(o, result);
    if (!o.out.empty()) write_results(o, result);
    if (!result.openings.empty())
        expect_vessel_size(result.openings[0],
                           o.unit.empty() ? "mm" : o.unit);   // first: in a wrong unit the rest means little
    if (const std::string why = refusals(result.checked.findings); !why.empty())
        throw GeometryError(fmt::format("the surface '{}' cannot be used yet:\n{}", o.path, why));
}

}   // namespace

void add_inspect_command(const Command& program, ExitCode&) {
    const Command command =
        program.add_command("inspect", "say what a surface is as a vessel: openings, sizes, defects, a picture");
    const auto o = std::make_shared<InspectOptions>();
    command
        .add_option("surface", o->path,
                    "a surface (STL, VTP, PLY, OBJ, legacy VTK), a label map (NIfTI, NRRD, MetaImage) or a network of "
                    "tubes (JSON, SWC, "
                    "VTP, legacy VTK)")
        .required();
    command.add_option("--unit", o->unit,
                       "of its coordinates, which only images and JSON networks say themselves: m, cm, mm or um");
    command.add_option("--label", o->label, "of a label map with several: which one is the vessel");
    command.add_option("--space", o->space, "its axes, if the file does not say: LPS or RAS");
    command.add_option("-o,--out", o->out, "a folder for the cleaned surface, the findings, the figures and a picture");
    command.add_option("--inlet", o->inlet,
                       "the opening that is the inlet, by name or number; the largest if not given");
    command.when_given([o] { run(*o); });
}

}   // namespace patency::app
