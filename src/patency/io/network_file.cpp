// SPDX-License-Identifier: Apache-2.0
#include "patency/io/network_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/base/units.h"
#include "patency/io/atomic_file.h"
#include "patency/io/surface_formats.h"

namespace patency {

namespace {

using Json = nlohmann::json;

bool is_json(std::string_view bytes) { return trimmed(bytes.substr(0, 4096)).starts_with("{"); }
bool is_vtk(std::string_view bytes) {
    return bytes.starts_with("# vtk DataFile") || bytes.substr(0, 4096).find("<VTKFile") != bytes.npos;
}
bool is_swc(const std::filesystem::path& path) { return path.extension() == ".swc" || path.extension() == ".SWC"; }

/// Numbers of a JSON array of that length.
std::vector<double> numbers_of(const SurfaceBytes& file, const Json& list, std::size_t count, const std::string& what) {
    if (!list.is_array() || list.size() != count) refuse_file(file, fmt::format("{} needs {} numbers.", what, count));
    std::vector<double> numbers;
    for (const Json& number : list) {
        if (!number.is_number()) refuse_file(file, fmt::format("{} needs {} numbers.", what, count));
        numbers.push_back(number.get<double>());
    }
    return numbers;
}

const Json& member(const SurfaceBytes& file, const Json& record, const char* key, const std::string& of) {
    if (!record.is_object() || !record.contains(key)) refuse_file(file, fmt::format("{} has no '{}'.", of, key));
    return record.at(key);
}

Network parse_json(const SurfaceBytes& file, std::string& unit, Json& ends) {
    Json json;
    try {
        json = Json::parse(file.bytes);
    } catch (const Json::exception& e) {
        refuse_file(file, fmt::format("it is no sound JSON ({}).", shortened(e.what(), 160)));
    }
    if (json.contains("unit")) {
        if (!json["unit"].is_string()) refuse_file(file, "its unit is no text.");
        unit = json["unit"].get<std::string>();
    }
    Network network;
    const Json& tubes = member(file, json, "tubes", "it");
    if (!tubes.is_array()) refuse_file(file, "its 'tubes' are no list.");
    for (std::size_t t = 0; t < tubes.size(); ++t) {
        const std::string of = fmt::format("tube {}", t + 1);
        Tube tube{.name = fmt::format("branch_{}", t + 1), .points = {}, .radii = {}};
        if (tubes[t].is_object() && tubes[t].contains("name")) {
            if (!tubes[t]["name"].is_string() || !is_plain_name(tubes[t]["name"].get<std::string>()))
                refuse_file(file, of + " has a 'name' that is none: letters, digits, _ and -, at most 64.");
            tube.name = tubes[t]["name"].get<std::string>();
        }
        const Json& points = member(file, tubes[t], "points", of);
        if (!points.is_array()) refuse_file(file, of + " has 'points' that are no list.");
        for (const Json& point : points) {
            const auto n =
                numbers_of(file, point, 4,
                           fmt::format("point {} of tube '{}' (x, y, z, radius)", tube.points.size() + 1, tube.name));
            tube.points.push_back({n[0], n[1], n[2]});
            tube.radii.push_back(n[3]);
        }
        network.tubes.push_back(std::move(tube));
    }
    if (json.contains("blend_width_k")) {
        if (!json["blend_width_k"].is_number()) refuse_file(file, "its 'blend_width_k' is no number.");
        network.blend = json["blend_width_k"].get<double>();
    }
    if (json.contains("ends")) ends = json["ends"];
    if (!ends.is_null() && !ends.is_object()) refuse_file(file, "its 'ends' are no record of names.");
    return network;
}

/// The openings that the file names, or all free ends.
void open_ends(const SurfaceBytes& file, const Json& ends, double per_metre, Network& network) {
    if (ends.is_null()) return open_free_ends(network);
    for (const auto& [name, end] : ends.items()) {
        if (!is_plain_name(name))
            refuse_file(
                file, fmt::format("'{}' is no name of an end: letters, digits, _ and -, at most 64.", shortened(name)));
        const std::string of = fmt::format("end '{}'", name);
        const auto p = numbers_of(file, member(file, end, "point", of), 3, "the point of " + of);
        const auto n = numbers_of(file, member(file, end, "outward_normal", of), 3, "the outward normal of " + of);
        const Vec3 normal{n[0], n[1], n[2]};
        if (!(norm(normal) > 0.9 && norm(normal) < 1.1))
            refuse_file(file, fmt::format("the outward normal of {} is no unit vector.", of));
        open_at(network, name, Vec3{p[0], p[1], p[2]} / per_metre, normal);
    }
}

Network parse_swc(const SurfaceBytes& file) {
    std::vector<Vec3> points;
    std::vector<double> radii;
    std::map<std::int64_t, std::uint32_t> index_of;
    std::vector<std::pair<std::uint32_t, std::int64_t>> parents;   // node, id of its parent
    Lines lines(file.bytes);
    while (const auto line = lines.next()) {
        std::string_view rest = trimmed(*line);
        if (rest.empty() || rest.starts_with('#')) continue;
        std::array<double, 7> n;   // id, type, x, y, z, radius, parent
        for (double& number : n) {
            const auto read = read_number(next_word(rest));
            if (!read)
                refuse_file(file, fmt::format("line {}: a node needs seven numbers: id, type, x, y, z, radius, parent.",
                                              lines.number()));
            number = *read;
        }
        constexpr double largest_id = 1e15;
        if (!(std::abs(n[0]) < largest_id && std::abs(n[6]) < largest_id) || n[0] != std::floor(n[0]) ||
            n[6] != std::floor(n[6]))
            refuse_file(file, fmt::format("line {}: ids are whole numbers.", lines.number()));
        if (!index_of.try_emplace(std::int64_t(n[0]), std::uint32_t(points.size())).second)
            refuse_file(file, fmt::format("line {}: a second node {}.", lines.number(), std::int64_t(n[0])));
        parents.emplace_back(std::uint32_t(points.size()), std::int64_t(n[6]));
        points.push_back({n[2], n[3], n[4]});
        radii.push_back(n[5]);
    }
    if (points.empty()) refuse_file(file, "it has no nodes.");
    std::vector<std::array<std::uint32_t, 2>> edges;
    constexpr std::uint32_t none = ~0u;
    std::vector<std::uint32_t> parent(points.size(), none);
    for (const auto& [node, id] : parents) {
        if (id < 0) continue;
        const auto found = index_of.find(id);
        if (found == index_of.end())
            refuse_file(file, fmt::format("a node has the parent {}, which is not there.", id));
        edges.push_back({found->second, node});
        parent[node] = found->second;
    }
    for (std::uint32_t node = 0; node < points.size(); ++node) {   // every way to the root must end
        std::size_t steps = 0;
        for (std::uint32_t at = node; parent[at] != none && steps <= points.size(); at = parent[at]) ++steps;
        if (steps > points.size())
            refuse_file(file, fmt::format("the parents of its node {} run in a circle.", node + 1));
    }
    return network_of_graph(points, radii, edges);
}

Network parse_vtk_network(const SurfaceBytes& file) {
    const CentrelineData data = parse_vtk_lines(file);
    Network network = network_of_graph(data.points, data.radii, data.edges);
    network.space = data.space;
    return network;
}

}   // namespace

bool holds_network(const std::filesystem::path& path) {
    if (is_swc(path)) return true;
    const std::string bytes = read_file(path);
    if (is_json(bytes)) return true;
    if (!is_vtk(bytes)) return false;
    const auto has = [&](std::string_view text) { return bytes.find(text) != bytes.npos; };
    return bytes.starts_with("# vtk") ? has("\nLINES ") && !has("\nPOLYGONS ") && !has("\nTRIANGLE_STRIPS ")
                                      : has("NumberOfPolys=\"0\"") && !has("NumberOfLines=\"0\"");
}

Network read_network(const std::filesystem::path& path, std::string_view unit, std::string_view space) {
    const std::vector<std::string> units = unit_names(Dimension::length);
    const auto is_unit = [&](std::string_view name) {
        return std::find(units.begin(), units.end(), name) != units.end();
    };
    if (!unit.empty() && !is_unit(unit))
        throw UsageError(
            fmt::format("'{}' is no unit of a network; it is one of {}.", shortened(unit), join(units, ", ", " or ")));
    if (!space.empty() && space != "LPS" && space != "RAS")
        throw UsageError(fmt::format("'{}' is no space; it is LPS or RAS.", shortened(space)));
    const std::string bytes = read_file(path);
    const SurfaceBytes file{path, bytes};
    std::string own_unit;
    Json ends;
    Network network =
        is_json(bytes)  ? parse_json(file, own_unit, ends)
        : is_vtk(bytes) ? parse_vtk_network(file)
        : is_swc(path)
            ? parse_swc(file)
            : (refuse_file(file, "it is no network in a format that is known here: JSON, SWC, VTP or legacy VTK."),
               Network{});
    if (!own_unit.empty() && !is_unit(own_unit))
        refuse_file(file,
                    fmt::format("its unit '{}' is not one of {}.", shortened(own_unit), join(units, ", ", " or ")));
    if (!own_unit.empty() && !unit.empty() && own_unit != unit)
        throw UsageError(fmt::format("'{}' says that its unit is {}, not {}.", path.string(), own_unit, unit));
    if (own_unit.empty() && unit.empty())
        throw UsageError(fmt::format("'{}' does not say its unit: give m, cm, mm or um.", path.string()));
    const double per_metre = in_unit(1, unit.empty() ? own_unit : unit);
    for (Tube& tube : network.tubes) {
        for (Vec3& x : tube.points) x = x / per_metre;
        for (double& r : tube.radii) r /= per_metre;
    }
    network.blend /= per_metre;
    if (!space.empty()) network.space = space;
    expect_tubes(network);
    if (is_vtk(bytes)) part_shared_tubes(network);
    open_ends(file, ends, per_metre, network);
    expect_sound(network);
    return network;
}

}   // namespace patency
