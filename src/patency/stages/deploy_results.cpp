// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_results.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "patency/io/csv.h"
#include "patency/shape/stent_metal.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

}   // namespace

OuterFaces outer_faces_of(const StrutCurves& curves, const StentAxis& axis) {
    OuterFaces faces;
    const double radius = outer_radius(curves), out = radius / curves.middle_radius;
    for (const Strut& strut : curves.struts)
        for (std::size_t k = 1; k < strut.points.size(); ++k) {
            const FlatPoint &a = strut.points[k - 1], &b = strut.points[k];
            const double length = std::hypot(out * (b.around - a.around), b.along - a.along);
            const int parts = std::max(1, int(std::ceil(length / (2 * strut.half_width))));   // no longer than wide
            for (int m = 0; m < parts; ++m) {
                const double t = (m + 0.5) / parts;
                const StentPoint at{radius, ((1 - t) * a.around + t * b.around) / curves.middle_radius,
                                    (1 - t) * a.along + t * b.along};
                faces.places.push_back(axis.place(at));
                faces.areas.push_back(length / parts * 2 * strut.half_width * out);
            }
        }
    return faces;
}

std::vector<StentPoint> seen_from(const StentAxis& axis, const std::vector<Vec3>& places) {
    std::vector<StentPoint> points;
    for (const Vec3& x : places) points.push_back(axis.coordinates(x));
    return points;
}

int slices_for(const StentPattern& pattern) {
    const int rings = pattern.rings > 0
                          ? pattern.rings
                          : int(std::lround(2 * pattern.length /
                                            pattern.diameter));   // of a surface: as many as its cells might be round
    return std::max(3, rings);
}

LumenGain lumen_gain(const StentPlace& place, const VesselAlong& before, const Vessel& after) {
    const VesselAlong& along = after.along.value();
    // The line that ends where the stent's does: openings may have other names now.
    const Centreline& own = before.lines.lines[place.line];
    const auto away = [&](const Centreline& line) { return norm(line.points.back().place - own.points.back().place); };
    const auto& lines = along.lines.lines;
    const std::size_t line = std::size_t(
        std::min_element(lines.begin(), lines.end(), [&](const auto& a, const auto& b) { return away(a) < away(b); }) -
        lines.begin());
    LumenGain gain{place.narrowest, Bounds::infinity, Bounds::infinity, place.reference_diameter, 0};
    const auto& points = along.lines.lines[line].points;
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (std::abs(place.axis.coordinates(points[k].place).along) > place.opened_length / 2) continue;
        gain.narrowest_after = std::min(gain.narrowest_after, 2 * points[k].radius);
        gain.least_area = std::min(gain.least_area, lumen_area(along, line, k));
    }
    const std::vector<double>& areas = before.assessment.healthy_area[place.line];
    gain.reference_area = 0.5 * (value_at(own, areas, place.start_arc()) + value_at(own, areas, place.end_arc()));
    return gain;
}

Json deploy_summary(const StentPlace& place, const StentProfile& shape, const StrutFit& fit,
                    const std::vector<JailedOstium>& ostia, const LumenGain& gain) {
    Json jailed = Json::array();
    for (const JailedOstium& o : ostia)
        jailed.push_back(
            {{"area_mm2", 1e6 * o.area}, {"centre_mm", {1e3 * o.centre.x, 1e3 * o.centre.y, 1e3 * o.centre.z}}});
    double ostia_area = 0;
    for (const JailedOstium& o : ostia) ostia_area += o.area;
    return {{"arc_length_mm", 1e3 * place.arc},
            {"wanted_diameter_mm", 1e3 * place.diameter},
            {"minimum_diameter_mm", 1e3 * shape.least_diameter},
            {"mean_diameter_mm", 1e3 * shape.mean_diameter},
            {"maximum_diameter_mm", 1e3 * shape.most_diameter},
            {"length_mm", 1e3 * shape.length},
            {"minimum_stent_area_mm2", 1e6 * shape.least_area},
            {"expansion_index", shape.least_area / gain.reference_area},
            {"dogboning_percent", 100 * dogboning(shape)},
            {"malapposed_percent", 100 * fit.malapposed},
            {"largest_gap_mm", 1e3 * fit.largest_gap},
            {"jailed_ostium_area_mm2", 1e6 * ostia_area},
            {"strut_area_over_ostia_mm2", 1e6 * fit.over_ostia},
            {"jailed_ostia", jailed},
            {"lumen",
             {{"minimum_diameter_before_mm", 1e3 * gain.narrowest_before},
              {"minimum_diameter_mm", 1e3 * gain.narrowest_after},
              {"minimum_area_mm2", 1e6 * gain.least_area},
              {"reference_diameter_mm", 1e3 * gain.reference_diameter},
              {"reference_area_mm2", 1e6 * gain.reference_area},
              {"residual_stenosis_percent", 100 * gain.residual_stenosis()}}}};
}

void write_stent_table(const std::filesystem::path& path, const StentProfile& shape) {
    CsvWriter table(path, {"along_mm", "mean_diameter_mm", "minimum_diameter_mm", "maximum_diameter_mm", "area_mm2"});
    for (const StentSlice& s : shape.slices)
        table.write_row(
            {1e3 * s.along, 1e3 * s.mean_diameter, 1e3 * s.least_diameter, 1e3 * s.most_diameter, 1e6 * s.area});
}

}   // namespace patency
