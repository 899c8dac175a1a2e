// SPDX-License-Identifier: Apache-2.0
#include "patency/io/centreline_file.h"

#include "patency/io/vtp.h"

namespace patency {

namespace {

constexpr double mm = 1e3, mm2 = 1e6;

}   // namespace

void write_centrelines(const std::filesystem::path& path, const BranchedLines& vessel,
                       const std::vector<std::vector<CrossSection>>& sections, const Assessment& assessment,
                       const std::string& space) {
    PointArray radius{"maximum_inscribed_sphere_radius", "mm"}, arc{"abscissas", "mm"},
        area{"centerline_section_area", "mm^2"}, normal{"centerline_section_normal", "1", 3},
        least{"centerline_section_min_size", "mm"}, most{"centerline_section_max_size", "mm"},
        healthy{"healthy_diameter", "mm"};
    IntegerArray branch{"branch_id"}, bifurcation{"bifurcation_id"}, closed{"centerline_section_closed"},
        shared{"centerline_section_bifurcation"};
    PolyData data{.space = space};
    for (std::size_t j = 0; j < vessel.lines.size(); ++j) {
        std::vector<std::uint32_t>& line = data.lines.emplace_back();
        for (std::size_t k = 0; k < vessel.lines[j].points.size(); ++k) {
            const CentrelinePoint& p = vessel.lines[j].points[k];
            const CrossSection& section = sections[j][k];
            line.push_back(std::uint32_t(data.points.size()));
            data.points.push_back(p.place);
            radius.values.push_back(mm * p.radius);
            arc.values.push_back(mm * p.arc);
            area.values.push_back(mm2 * section.area);
            normal.values.insert(normal.values.end(), {p.tangent.x, p.tangent.y, p.tangent.z});
            least.values.push_back(mm * section.least_width);
            most.values.push_back(mm * section.most_width);
            healthy.values.push_back(mm * assessment.healthy_diameter[j][k]);
            branch.values.push_back(vessel.branch_ids[j][k]);
            bifurcation.values.push_back(vessel.bifurcation_ids[j][k]);
            closed.values.push_back(section.is_closed);
            shared.values.push_back(section.is_shared);
        }
    }
    data.arrays = {radius, arc, area, normal, least, most, healthy};
    data.integers = {branch, bifurcation, closed, shared};
    write_polydata(path, data);
}

}   // namespace patency
