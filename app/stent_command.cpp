// SPDX-License-Identifier: Apache-2.0
// patency stent: the library of designs, one of them in figures, or a stent that comes as a surface. With -o the metal's
// surface, its particles, figures and a picture.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "command_line.h"
#include "commands.h"
#include "patency/base/units.h"
#include "patency/bodies/stent.h"
#include "patency/config/deck.h"
#include "patency/io/atomic_file.h"
#include "patency/io/csv.h"
#include "patency/io/output_folder.h"
#include "patency/io/stent_picture.h"
#include "patency/io/summary.h"
#include "patency/io/surface_file.h"
#include "patency/io/vtp.h"
#include "patency/shape/stent_import.h"
#include "patency/shape/stent_library.h"
#include "patency/shape/surface_distance.h"
#include "patency/stages/stent_of_case.h"

namespace patency::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct StentOptions {
    std::string name, path, unit, space, spacing, out;   // as the command line has them
    std::string line, at, turn;
};

/// The largest and the smallest cell by their circles, and both extremes of their areas.
struct CellRange {
    double inscribed = 0, largest_area = 0, smallest_area = 0, largest_perimeter = 0;
};
CellRange range_of(const std::vector<StentCell>& cells) {
    CellRange r;
    for (const StentCell& cell : cells) {
        r.inscribed = std::max(r.inscribed, cell.inscribed);
        r.largest_area = std::max(r.largest_area, cell.area);
        r.smallest_area = r.smallest_area > 0 ? std::min(r.smallest_area, cell.area) : cell.area;
        r.largest_perimeter = std::max(r.largest_perimeter, cell.perimeter);
    }
    return r;
}

struct Described {
    StentPattern pattern;
    StrutCurves curves;
    StentMeasures measures;
};
Described describe(const StentPattern& pattern) {
    const StrutCurves curves = make_strut_curves(pattern);
    return {pattern, curves, measure_stent(curves)};
}

void print_library() {
    fmt::print("{:<15} {:>28} {:>9} {:>12} {:>8} {:>8}\n", "name", "outer mm: cut, crimped, open", "length mm",
               "strut um", "alloy", "rings");
    for (const StentDesign& design : stent_library()) {
        const StentPattern& p = design.pattern;
        fmt::print("{:<15} {:>12.2f} {:>8.2f} {:>6.2f} {:>9.2f} {:>12} {:>8} {:>8}\n    {}\n", design.name,
                   1e3 * p.diameter, 1e3 * p.crimped_diameter, 1e3 * p.nominal_diameter, 1e3 * p.length,
                   fmt::format("{:.0f} x {:.0f}", 1e6 * p.strut_width, 1e6 * p.strut_thickness), p.alloy,
                   fmt::format("{} x {}", p.rings, p.crowns), design.description);
    }
}

void print_state(const char* state, const Described& d) {
    const CellRange cells = range_of(d.measures.cells);
    fmt::print("  {:<10} {:>8.3f} {:>9.3f} {:>9.1f} {:>6} {:>13.3f} {:>7.3f} {:>7.3f} {:>14.3f}\n", state,
               1e3 * d.pattern.diameter, 1e3 * d.pattern.length, 100 * d.measures.metal_ratio, d.measures.cells.size(),
               1e3 * cells.inscribed, 1e6 * cells.smallest_area, 1e6 * cells.largest_area,
               1e3 * cells.largest_perimeter);
}

Json as_json(const Described& d) {
    const CellRange cells = range_of(d.measures.cells);
    return {{"outer_diameter_mm", 1e3 * d.pattern.diameter},
            {"length_mm", 1e3 * d.pattern.length},
            {"metal_to_artery_percent", 100 * d.measures.metal_ratio},
            {"cells", d.measures.cells.size()},
            {"largest_circle_in_cell_mm", 1e3 * cells.inscribed},
            {"smallest_cell_area_mm2", 1e6 * cells.smallest_area},
            {"largest_cell_area_mm2", 1e6 * cells.largest_area},
            {"largest_cell_perimeter_mm", 1e3 * cells.largest_perimeter}};
}

void add_particles(Json& json, const OutputFolder& folder, const StentParticles& particles, double spacing) {
    write_particles(folder.file("particles.vtp"), particles);
    double sum = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) sum += particles.volume[i];
    json["particles"] = {{"count", particles.size()}, {"spacing_um", 1e6 * spacing}, {"volume_mm3", 1e9 * sum}};
}

/// What is shown: a design of the library, or the stent of a deck.
struct Shown {
    std::string name, description, source;
    StentPattern pattern;
    std::optional<double> spacing;   ///< m
    deck::StentPlacement placement{.branch = {}, .arc_length = {}, .translation = Vec3{}};
};
Shown find_shown(const StentOptions& o) {
    Shown shown;
    const bool is_deck = o.name.ends_with(".yaml") || o.name.ends_with(".yml") || o.name.ends_with(".json");
    if (is_deck) {
        const deck::Case config = deck::read_case(o.name);
        if (!config.stent) throw DeckError(fmt::format("{}: it has no stent", o.name));
        if (config.stent->surface) throw DeckError("stent.surface: patency stent import shows surfaces");
        shown = {fs::path(o.name).stem().string(), "the stent of a deck", o.name, make_stent_pattern(*config.stent),
                 config.stent->spacing};
        if (config.stent->placement) shown.placement = *config.stent->placement;
    } else {
        try {
            const StentDesign& design = find_stent(o.name);
            shown = {design.name, design.description, design.source, design.pattern, {}};
        } catch (const GeometryError& unknown) {   // the command line's mistake, and no file's
            throw UsageError(unknown.what());
        }
    }
    if (!o.spacing.empty()) shown.spacing = parse_quantity(o.spacing, Dimension::length);
    if (!o.at.empty())
        shown.placement = {.branch = {}, .arc_length = parse_quantity(o.at, Dimension::length), .translation = {}};
    if (!o.turn.empty()) shown.placement.rotation = parse_quantity(o.turn, Dimension::angle);
    return shown;
}

/// A line from a table with the columns x_mm, y_mm, z_mm; none without a file.
std::vector<Vec3> read_line(const std::string& path) {
    if (path.empty()) return {};
    const CsvTable table = read_csv(path);
    const auto *x = table.find("x_mm"), *y = table.find("y_mm"), *z = table.find("z_mm");
    if (!x || !y || !z) throw DeckError(fmt::format("{}: a line needs the columns x_mm, y_mm and z_mm", path));
    std::vector<Vec3> line;
    for (std::size_t k = 0; k < x->size(); ++k) line.push_back(1e-3 * Vec3{(*x)[k], (*y)[k], (*z)[k]});
    return line;
}

void print_figures(const Shown& shown, const Described& cut, const Described& open) {
    const StentPattern& p = shown.pattern;
    const StentMeasures& m = cut.measures;
    const Alloy& alloy = find_alloy(p.alloy);
    fmt::print("{}: {}\n  source      {}\n", shown.name, shown.description, shown.source);
    fmt::print("  pattern     {} {} of {} crowns, {} connectors each\n", p.rings,
               p.layout == StentLayout::helix ? "turns" : "rings", p.crowns, p.connectors);
    fmt::print("  struts      {:.0f} um wide, {:.0f} um thick, crowns of radius {:.0f} um\n", 1e6 * p.strut_width,
               1e6 * p.strut_thickness, 1e6 * p.crown_radius);
    fmt::print("  metal       {:.4g} mm^3, surface {:.4g} mm^2, {:.4g} mg of {} ({})\n", 1e9 * m.volume,
               1e6 * m.surface_area, 1e6 * m.volume * alloy.density, alloy.name, alloy.description);
    fmt::print("  crimped     {:.3f} mm outer diameter; foreshortening when it opens {:.1f} %\n",
               1e3 * p.crimped_diameter, 100 * (1 - open.pattern.length / p.length));
    fmt::print("  {:<10} {:>8} {:>9} {:>9} {:>6} {:>13} {:>15} {:>14}\n", "state", "outer mm", "length mm", "metal %",
               "cells", "circle in mm", "areas mm^2", "free edge mm");
    print_state("as cut", cut);
    print_state("open", open);
}

void show(const StentOptions& o) {
    const Shown shown = find_shown(o);
    const StentPattern& p = shown.pattern;
    const Described cut = describe(p), open = describe(at_diameter(p, p.nominal_diameter));
    const StentAxis axis = make_stent_axis(shown.placement, p, read_line(o.line));
    print_figures(shown, cut, open);
    if (o.out.empty()) return;

    const StentMeasures& m = cut.measures;
    const OutputFolder folder(o.out);
    Json json{{"stent", shown.name},
              {"source", shown.source},
              {"alloy", p.alloy},
              {"strut_width_um", 1e6 * p.strut_width},
              {"strut_thickness_um", 1e6 * p.strut_thickness},
              {"crimped_diameter_mm", 1e3 * p.crimped_diameter},
              {"metal_volume_mm3", 1e9 * m.volume},
              {"metal_surface_mm2", 1e6 * m.surface_area},
              {"metal_mass_mg", 1e6 * m.volume * find_alloy(p.alloy).density},
              {"foreshortening_percent", 100 * (1 - open.pattern.length / p.length)},
              {"as_cut", as_json(cut)},
              {"open", as_json(open)}};
    write_surface(folder.file("surface.vtp"), make_stent_surface(cut.curves, axis));
    StentParticles particles;
    const double spacing = shown.spacing.value_or(largest_stent_spacing(cut.curves));
    make_stent_particles(cut.curves, axis, spacing, particles);
    add_particles(json, folder, particles, spacing);
    write_summary(folder.file("stent.json"), json);
    write_file(
        folder.file("stent.svg"),
        draw_stent(
            cut.curves, m.cells, shown.name,
            {shown.description,
             fmt::format(
                 "{:.2f} mm x {:.2f} mm as cut, struts {:.0f} x {:.0f} um, metal {:.3g} mm^3, {:.1f} % of the artery",
                 1e3 * p.diameter, 1e3 * p.length, 1e6 * p.strut_width, 1e6 * p.strut_thickness, 1e9 * m.volume,
                 100 * m.metal_ratio)}));
    write_file(folder.file("open.svg"),
               draw_stent(open.curves, open.measures.cells, shown.name + ", open",
                          {fmt::format("{:.2f} mm x {:.2f} mm, {:.1f} % of the artery", 1e3 * open.pattern.diameter,
                                       1e3 * open.pattern.length, 100 * open.measures.metal_ratio)}));
}

void import(const StentOptions& o) {
    const ImportedStent stent = recognise_stent(read_surface(o.path, o.unit, o.space));
    const Vec3 axis = stent.placement.turn({1, 0, 0}), middle = stent.placement.origin;
    fmt::print("{} (unit {})\n", o.path, o.unit);
    fmt::print("  axis        {:.4f} {:.4f} {:.4f}, middle at {:.3f} {:.3f} {:.3f} mm, asymmetry {:.2g} %\n", axis.x,
               axis.y, axis.z, 1e3 * middle.x, 1e3 * middle.y, 1e3 * middle.z, 100 * stent.asymmetry);
    fmt::print("  diameter    {:.3f} mm (outer)\n  length      {:.3f} mm\n  thickness   {:.1f} um\n",
               1e3 * stent.diameter, 1e3 * stent.length, 1e6 * stent.strut_thickness);
    fmt::print("  metal       {:.4g} mm^3, surface {:.4g} mm^2\n", 1e9 * stent.volume, 1e6 * stent.area);
    if (o.out.empty()) return;

    const OutputFolder folder(o.out);
    Json json{{"file", fs::path(o.path).filename().string()},
              {"unit", o.unit},
              {"axis", {axis.x, axis.y, axis.z}},
              {"middle_mm", {1e3 * middle.x, 1e3 * middle.y, 1e3 * middle.z}},
              {"asymmetry_percent", 100 * stent.asymmetry},
              {"outer_diameter_mm", 1e3 * stent.diameter},
              {"length_mm", 1e3 * stent.length},
              {"strut_thickness_um", 1e6 * stent.strut_thickness},
              {"metal_volume_mm3", 1e9 * stent.volume},
              {"metal_surface_mm2", 1e6 * stent.area}};
    write_surface(folder.file("surface.vtp"), stent.surface);
    const double spacing =
        o.spacing.empty() ? stent.strut_thickness / least_across : parse_quantity(o.spacing, Dimension::length);
    StentParticles particles;
    make_stent_particles(make_surface_distance(stent.surface, spacing), stent.volume, spacing, particles);
    add_particles(json, folder, particles, spacing);
    write_summary(folder.file("stent.json"), json);
    write_file(folder.file("stent.svg"),
               draw_stent(stent.surface, stent.diameter, fs::path(o.path).filename().string(),
                          {fmt::format("{:.2f} mm x {:.2f} mm, struts {:.0f} um thick", 1e3 * stent.diameter,
                                       1e3 * stent.length, 1e6 * stent.strut_thickness)}));
}

}   // namespace

void add_stent_command(const Command& program, ExitCode&) {
    const Command command = program.add_command("stent", "the library of stents, and stents from surfaces");
    command.expect_one_of_its_commands();
    const auto o = std::make_shared<StentOptions>();
    command.add_command("list", "the designs by name").when_given(print_library);
    const auto add_output = [&](const Command& sub) {
        sub.add_option("--spacing", o->spacing,
                       "of the particles, such as \"20 um\"; a quarter of a strut if not given");
        sub.add_option("-o,--out", o->out, "a folder for the metal's surface, its particles, figures and a picture");
    };
    const Command show_command = command.add_command("show", "one design in figures");
    show_command.add_option("name", o->name, "the design, or a deck with a stent (YAML)").required();
    show_command.add_option("--line", o->line, "a line to lie along: a table (CSV) with the columns x_mm, y_mm, z_mm");
    show_command.add_option("--at", o->at, "where the stent's middle is on the line, such as \"12 mm\"");
    show_command.add_option("--turn", o->turn, "around its axis, such as \"30 deg\"");
    add_output(show_command);
    show_command.when_given([o] { show(*o); });
    const Command import_command = command.add_command("import", "a stent's surface: its axis and its figures");
    import_command.add_option("surface", o->path, "the closed surface of the metal: STL, VTP, PLY, OBJ or legacy VTK")
        .required();
    import_command.add_option("--unit", o->unit, "of its coordinates: m, cm, mm or um").required();
    import_command.add_option("--space", o->space, "its axes, if the file does not say: LPS or RAS");
    add_output(import_command);
    import_command.when_given([o] { import(*o); });
}

}   // namespace patency::app
