// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/vessel_results.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/analysis/streamlines.h"
#include "patency/io/csv.h"
#include "patency/io/vtp.h"
#include "patency/stages/scene_sampling.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

constexpr double distance_to_reading =
    15e-3;   // m behind a lesion's end: in the middle of 10 to 20 mm (Norgaard et al. 2019)
constexpr double mm = 1e3;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

bool passes(const Branch& branch, std::size_t line) {
    return std::find(branch.lines.begin(), branch.lines.end(), line) != branch.lines.end();
}

/// The stations that a line passes, from the inlet on.
std::vector<const StationFlow*> stations_along(const VesselAlong& along, const VesselRecorder& recorder,
                                               const VesselFlow& flow, std::size_t line) {
    std::vector<const StationFlow*> found;
    for (const StationFlow& s : flow.stations)
        if (passes(along.lines.branches[recorder.stations()[s.station].branch], line)) found.push_back(&s);
    const auto arc = [&](const StationFlow* s) { return recorder.stations()[s->station].arc; };
    std::sort(found.begin(), found.end(), [&](const StationFlow* a, const StationFlow* b) { return arc(a) < arc(b); });
    return found;
}

/// A number of the stations at an arc, linear between them, the ends' beyond.
template <class Value>
double at_arc(const std::vector<const StationFlow*>& stations, const VesselRecorder& recorder, double arc,
              Value value) {
    const auto arc_of = [&](const StationFlow* s) { return recorder.stations()[s->station].arc; };
    const auto after =
        std::find_if(stations.begin(), stations.end(), [&](const StationFlow* s) { return arc_of(s) >= arc; });
    if (after == stations.begin()) return value(**after);
    if (after == stations.end()) return value(*stations.back());
    const StationFlow &a = **std::prev(after), &b = **after;
    const double share = (arc - arc_of(&a)) / (arc_of(&b) - arc_of(&a));
    return value(a) + share * (value(b) - value(a));
}

double pressure_at(const std::vector<const StationFlow*>& stations, const VesselRecorder& recorder, double arc) {
    return at_arc(stations, recorder, arc, [](const StationFlow& s) { return s.flow.pressure; });
}

bool is_finite(const SectionFlow& s) { return std::isfinite(s.flow + s.pressure + s.mean_velocity + s.peak_velocity); }

std::optional<LesionFlow> evaluate_lesion(const Scene& scene, const VesselRecorder& recorder, const VesselFlow& flow,
                                          std::size_t number, double lowest_outlet) {
    const VesselAlong& along = *scene.vessel->along;
    const Lesion& lesion = along.assessment.lesions[number];
    const auto stations = stations_along(along, recorder, flow, lesion.line);
    if (stations.size() < 2) return {};
    LesionFlow result{
        .number = number,
        .flow = at_arc(stations, recorder, lesion.throat_arc, [](const StationFlow& s) { return s.flow.flow; }),
        .drop = 0,
        .read_arc = 0,
        .across = lesion.minimum_diameter /
                  spacing_at(scene, point_at(along.lines.lines[lesion.line], lesion.throat_arc).place),
        .velocity_before = 0,
        .velocity_behind = 0,
        .gauge_ratio = {},
        .ffr = {}};
    result.read_arc = std::min(lesion.end_arc + distance_to_reading, recorder.stations()[stations.back()->station].arc);
    const double read = pressure_at(stations, recorder, result.read_arc);
    result.drop = pressure_at(stations, recorder, lesion.start_arc) - read;
    const auto velocity = [](const StationFlow& s) { return s.flow.mean_velocity; };
    result.velocity_before = at_arc(stations, recorder, lesion.throat_arc - lesion.length(), velocity);
    result.velocity_behind = at_arc(stations, recorder, lesion.throat_arc + lesion.length(), velocity);
    const double before = pressure_at(stations, recorder, lesion.throat_arc - lesion.length()) - lowest_outlet;
    const double behind = pressure_at(stations, recorder, lesion.throat_arc + lesion.length()) - lowest_outlet;
    if (before > 0) result.gauge_ratio = behind / before;
    if (scene.config.aorta.pressure) result.ffr = (read + flow.level) / *scene.config.aorta.pressure;
    return result;
}

/// Of the estimate, at an arc of a branch [Pa].
double estimated_pressure(const Estimate& e, std::size_t branch, double arc) {
    const auto& arcs = e.tree.branches[branch].arc;
    const auto after = std::lower_bound(arcs.begin(), arcs.end(), arc);
    const auto& p = e.flow.pressure[branch];
    if (after == arcs.begin()) return p.front();
    if (after == arcs.end()) return p.back();
    const std::size_t k = std::size_t(after - arcs.begin());
    return p[k - 1] + (arc - arcs[k - 1]) / (arcs[k] - arcs[k - 1]) * (p[k] - p[k - 1]);
}

Json lesion_summary(const Scene& scene, const LesionFlow& l) {
    const VesselAlong& along = *scene.vessel->along;
    const Lesion& lesion = along.assessment.lesions[l.number];
    const EstimatedLesion& estimated = scene.estimate->lesions[l.number];
    return {{"branch", along.lines.branches[lesion.branch].name},
            {"throat_arc_mm", mm * lesion.throat_arc},
            {"start_arc_mm", mm * lesion.start_arc},
            {"length_mm", mm * lesion.length()},
            {"diameter_stenosis_percent", 100 * lesion.diameter_stenosis},
            {"area_stenosis_percent", 100 * lesion.area_stenosis},
            {"minimum_diameter_mm", mm * lesion.minimum_diameter},
            {"flow_m3_per_s", l.flow},
            {"velocity_before_m_per_s", l.velocity_before},
            {"velocity_behind_m_per_s", l.velocity_behind},
            {"drop_pa", l.drop},
            {"read_arc_mm", mm * l.read_arc},
            {"gauge_pressure_ratio", or_null(l.gauge_ratio)},
            {"ffr", or_null(l.ffr)},
            {"particles_across", l.across},
            {"is_under_resolved", l.across < fewest_across},
            {"estimated_drop_pa", estimated.drop},
            {"estimated_ffr", or_null(estimated.ffr)}};
}

Json branch_summary(const Scene& scene, const VesselRecorder& recorder, const VesselFlow& flow, std::size_t b) {
    const Branch& branch = scene.vessel->along->lines.branches[b];
    Json json{{"name", branch.name},
              {"length_mm",
               mm * (scene.vessel->along->lines.end_arc(branch) - scene.vessel->along->lines.start_arc(branch))}};
    const StationFlow *first = nullptr, *last = nullptr;
    double sum = 0, count = 0, least_across = INFINITY;
    for (const StationFlow& s : flow.stations) {
        if (recorder.stations()[s.station].branch != b) continue;
        if (!first) first = &s;
        last = &s;
        sum += s.flow.flow, count += 1;
        least_across = std::min(least_across, s.across);
    }
    if (!first) return json;
    json["flow_m3_per_s"] = sum / count;
    json["pressure_begin_pa"] = first->flow.pressure;
    json["pressure_end_pa"] = last->flow.pressure;
    json["ffr_end"] = or_null(last->ffr);
    json["particles_across"] = least_across;
    json["is_under_resolved"] = least_across < fewest_across;
    json["estimated_flow_m3_per_s"] = scene.estimate->flow.flow[b];
    return json;
}

const std::vector<std::string> flow_columns{"x_m",
                                            "y_m",
                                            "z_m",
                                            "area_m2",
                                            "flow_m3_per_s",
                                            "pressure_pa",
                                            "mean_velocity_m_per_s",
                                            "peak_velocity_m_per_s",
                                            "flow_deviation_m3_per_s",
                                            "pressure_deviation_pa",
                                            "particles_across",
                                            "estimated_pressure_pa"};

std::vector<double> row_of(const Scene& scene, const VesselRecorder& recorder, const StationFlow& s, double second) {
    const VesselStation& station = recorder.stations()[s.station];
    const Vec3& x = station.plane.centre;
    std::vector<double> row{station.arc,
                            second,
                            x.x,
                            x.y,
                            x.z,
                            s.flow.area,
                            s.flow.flow,
                            s.flow.pressure,
                            s.flow.mean_velocity,
                            s.flow.peak_velocity,
                            s.deviation.flow,
                            s.deviation.pressure,
                            s.across,
                            estimated_pressure(*scene.estimate, station.branch, station.arc) + scene.datum};
    if (s.ffr) row.push_back(*s.ffr);
    return row;
}

/// Columns: the arc, a number of what the row belongs to, then the flow's.
CsvWriter table(const OutputFolder& folder, const char* name, const char* second, bool has_ffr) {
    std::vector<std::string> columns{"arc_m", second};
    columns.insert(columns.end(), flow_columns.begin(), flow_columns.end());
    if (has_ffr) columns.push_back("ffr");
    return {folder.file(name), columns};
}

void write_wall(const OutputFolder& folder, const Scene& scene, const VesselRecorder& recorder, double level) {
    const Surface& surface = recorder.wall().surface;
    PolyData data{.points = surface.points, .triangles = surface.triangles, .space = surface.space};
    PointArray pressure{"pressure", "Pa"}, shear{"wall_shear_stress", "Pa", 3}, tawss{"tawss", "Pa"}, osi{"osi", "1"},
        rrt{"rrt", "1/Pa"};
    PointArray seen{"is_resolved", "1"};
    const auto mean = recorder.shear().mean();
    const auto tawss_values = recorder.shear().tawss(), osi_values = recorder.shear().osi(),
               rrt_values = recorder.shear().rrt();
    const auto pressures = recorder.wall_pressure();
    for (std::size_t k = 0; k < mean.size(); ++k) {
        // Where no blood was near there is no value; files have zeros there and say so.
        const bool is_seen = std::isfinite(tawss_values[k] + pressures[k] + rrt_values[k]);
        seen.values.push_back(is_seen);
        pressure.values.push_back(is_seen ? pressures[k] : 0);
        const Vec3 t = is_seen ? mean[k] : Vec3{};
        shear.values.insert(shear.values.end(), {t.x, t.y, t.z});
        tawss.values.push_back(is_seen ? tawss_values[k] : 0);
        osi.values.push_back(is_seen ? osi_values[k] : 0);
        rrt.values.push_back(is_seen ? rrt_values[k] : 0);
    }
    data.arrays = {pressure, shear, tawss, osi, rrt, seen};
    if (const auto& aortic = scene.config.aorta.pressure) {
        PointArray ffr{"ffr", "1"};
        for (std::size_t k = 0; k < mean.size(); ++k)
            ffr.values.push_back(seen.values[k] != 0 ? (pressure.values[k] + level) / *aortic : 0);
        data.arrays.push_back(ffr);
    }
    write_polydata(folder.file("wall.vtp"), data);
}

void write_centreline(const OutputFolder& folder, const Scene& scene, const VesselRecorder& recorder,
                      const VesselFlow& flow) {
    const VesselAlong& along = *scene.vessel->along;
    PolyData data{.space = scene.vessel->checked.surface.space};
    PointArray arc{"abscissas", "mm"}, radius{"maximum_inscribed_sphere_radius", "mm"}, pressure{"pressure", "Pa"},
        rate{"flow", "m^3/s"}, mean{"mean_velocity", "m/s"}, peak{"peak_velocity", "m/s"}, ffr{"ffr", "1"};
    IntegerArray branch{"branch_id"};
    for (std::size_t line = 0; line < along.lines.lines.size(); ++line) {
        const auto stations = stations_along(along, recorder, flow, line);
        if (stations.size() < 2) continue;   // no line
        std::vector<std::uint32_t>& cell = data.lines.emplace_back();
        for (const StationFlow* s : stations) {
            const VesselStation& station = recorder.stations()[s->station];
            cell.push_back(std::uint32_t(data.points.size()));
            data.points.push_back(station.plane.centre);
            arc.values.push_back(mm * station.arc);
            radius.values.push_back(mm * station.plane.radius);
            pressure.values.push_back(s->flow.pressure);
            rate.values.push_back(s->flow.flow);
            mean.values.push_back(s->flow.mean_velocity);
            peak.values.push_back(s->flow.peak_velocity);
            if (s->ffr) ffr.values.push_back(*s->ffr);
            branch.values.push_back(std::int32_t(station.branch));
        }
    }
    data.arrays = {arc, radius, pressure, rate, mean, peak};
    if (!ffr.values.empty()) data.arrays.push_back(ffr);
    data.integers = {branch};
    write_polydata(folder.file("centerline.vtp"), data);
}

void write_streamlines(const OutputFolder& folder, const Scene& scene, const VesselRecorder& recorder) {
    PolyData data{.space = scene.vessel->checked.surface.space};
    PointArray velocity{"velocity", "m/s", 3}, pressure{"pressure", "Pa"};
    if (recorder.stations().empty()) {   // a vessel too short for any: nowhere to begin
        data.arrays = {velocity, pressure};
        return write_polydata(folder.file("streamlines.vtp"), data);
    }
    const WallHint hint = wall_hint(scene);
    const SectionPlane inlet = recorder.stations().front().plane;   // the inlet's branch is the first
    constexpr int seeds_across_radius = 4;
    const SectionGrid seeds = make_section_grid(inlet, hint, seeds_across_radius);
    double length = 0;
    for (const Centreline& line : scene.vessel->along->lines.lines) length = std::max(length, line.length());
    const StreamlineRule rule{
        .step = [&](const Vec3& x) { return spacing_at(scene, x); },
        .longest = 2 * length,
        .slowest = 1e-3 * scene.numerics.reference_speed,
        .reach = sampling_reach(scene),
        .is_inside = [&](const Vec3& x) { return hint.distance(x) < 0 && opening_beyond(scene.lumen, x) < 0; }};
    for (const Streamline& line : trace_streamlines(scene.fluid, *scene.frame, seeds.place, rule, hint)) {
        if (line.points.size() < 2) continue;
        std::vector<std::uint32_t>& cell = data.lines.emplace_back();
        for (std::size_t k = 0; k < line.points.size(); ++k) {
            cell.push_back(std::uint32_t(data.points.size()));
            data.points.push_back(line.points[k]);
            velocity.values.insert(velocity.values.end(), {line.velocity[k].x, line.velocity[k].y, line.velocity[k].z});
            pressure.values.push_back(line.pressure[k] + scene.level());
        }
    }
    data.arrays = {velocity, pressure};
    write_polydata(folder.file("streamlines.vtp"), data);
}

}   // namespace

VesselFlow evaluate_vessel(const Scene& scene, const VesselRecorder& recorder, double inlet_pressure,
                           double lowest_outlet, std::span<const double> out) {
    VesselFlow result;
    std::vector<double> along;
    if (!out.empty()) along = branch_flows(scene.vessel->along->lines, scene.lumen.openings, out);
    const auto& aortic = scene.config.aorta.pressure;
    if (aortic) result.level = *aortic - inlet_pressure;
    const auto means = recorder.flows().mean(), deviations = recorder.flows().deviation();
    for (std::size_t k = 0; k < means.size(); ++k) {
        if (!is_finite(means[k])) continue;
        StationFlow s{k,
                      means[k],
                      deviations[k],
                      2 * recorder.stations()[k].plane.radius / spacing_at(scene, recorder.stations()[k].plane.centre),
                      {}};
        if (!along.empty()) {
            s.flow.flow = along[recorder.stations()[k].branch];
            s.flow.mean_velocity = s.flow.flow / s.flow.area;
        }
        if (aortic) s.ffr = (s.flow.pressure + result.level) / *aortic;
        result.stations.push_back(s);
    }
    for (std::size_t n = 0; n < scene.vessel->along->assessment.lesions.size(); ++n)
        if (auto lesion = evaluate_lesion(scene, recorder, result, n, lowest_outlet)) {
            if (lesion->ffr) result.worst_ffr = std::min(result.worst_ffr.value_or(*lesion->ffr), *lesion->ffr);
            result.lesions.push_back(*lesion);
        }
    return result;
}

void add_vessel_summary(Json& summary, const Scene& scene, const VesselRecorder& recorder, const VesselFlow& flow) {
    Json branches = Json::array(), lesions = Json::array();
    for (std::size_t b = 0; b < scene.vessel->along->lines.branches.size(); ++b)
        branches.push_back(branch_summary(scene, recorder, flow, b));
    for (const LesionFlow& l : flow.lesions) lesions.push_back(lesion_summary(scene, l));
    summary["gauge_pressure_ratio"] = flow.lesions.empty() ? Json(nullptr) : or_null(flow.lesions.front().gauge_ratio);
    summary["ffr"] = {{"lesion", or_null(flow.worst_ffr)}};
    if (!flow.worst_ffr)
        summary["ffr"]["reason"] = !scene.config.aorta.pressure ? "the deck gives no aortic pressure"
                                   : scene.vessel->along->assessment.lesions.empty()
                                       ? "no lesion was found"
                                       : "the lesion's vessel is too short or too coarse for two sections along it";
    if (scene.config.aorta.pressure) {
        summary["aortic_pressure_pa"] = *scene.config.aorta.pressure;
        summary["pressure_level_pa"] = flow.level;   // what FFR adds to pressures
    }
    summary["branches"] = branches;
    summary["lesions"] = lesions;
    summary["instants_averaged"] = recorder.instants();
}

void write_vessel_files(const OutputFolder& folder, const Scene& scene, const VesselRecorder& recorder,
                        const VesselFlow& flow) {
    const VesselAlong& along = *scene.vessel->along;
    const bool has_ffr = scene.config.aorta.pressure.has_value();
    CsvWriter sections = table(folder, "sections.csv", "branch", has_ffr);
    for (const StationFlow& s : flow.stations)
        sections.write_row(row_of(scene, recorder, s, double(recorder.stations()[s.station].branch + 1)));
    CsvWriter pullback = table(folder, "pullback.csv", "outlet", has_ffr);
    for (std::size_t line = 0; line < along.lines.lines.size(); ++line)
        for (const StationFlow* s : stations_along(along, recorder, flow, line))
            pullback.write_row(row_of(scene, recorder, *s, double(line + 1)));
    write_wall(folder, scene, recorder, flow.level);
    write_centreline(folder, scene, recorder, flow);
    recorder.cut().write(folder.file("cut.vtp"));
    write_streamlines(folder, scene, recorder);
}

}   // namespace patency
