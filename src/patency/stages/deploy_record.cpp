// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_record.h"

#include <string>
#include <vector>

namespace patency {

namespace {

const std::vector<std::string> table_columns = {"time_s",
                                                "phase",
                                                "tool_radius_mm",
                                                "mean_diameter_mm",
                                                "minimum_diameter_mm",
                                                "maximum_diameter_mm",
                                                "length_mm",
                                                "tool_pressure_pa",
                                                "stent_kinetic_j",
                                                "stent_internal_j",
                                                "stent_plastic_j",
                                                "wall_kinetic_j",
                                                "wall_internal_j",
                                                "penetration_mm",
                                                "pace"};

PvdWriter series(const OutputFolder& folder, const char* name, std::optional<double> from) {
    return from ? PvdWriter::resumed(folder.file(name), *from) : PvdWriter(folder.file(name));
}

CsvWriter table(const OutputFolder& folder, std::optional<double> from) {
    const auto path = folder.file("deployment.csv");
    return from ? CsvWriter::resumed(path, table_columns, *from) : CsvWriter(path, table_columns);
}

}   // namespace

DeployRecord::DeployRecord(const OutputFolder& folder, std::optional<double> from)
    : folder_(folder),
      stent_(series(folder, "stent.pvd", from)),
      wall_(series(folder, "wall.pvd", from)),
      table_(table(folder, from)) {}

void DeployRecord::add(const DeployInstant& now, const StentProfile& profile) {
    table_.write_row({now.time, double(now.phase), 1e3 * now.tool_radius, 1e3 * profile.mean_diameter,
                      1e3 * profile.least_diameter, 1e3 * profile.most_diameter, 1e3 * profile.length,
                      now.tool_pressure, now.stent.kinetic, now.stent.internal, now.stent.plastic, now.wall.kinetic,
                      now.wall.internal, 1e3 * now.deepest, now.pace});
}

void DeployRecord::add_frames(double time, const PolyData& stent, const PolyData& wall) {
    const auto write = [&](PvdWriter& to, const PolyData& data, const char* name) {
        const bool is_again = to.ends_at(time);   // with more to show
        const auto file = frame_file(name, to.size() - is_again);
        write_polydata(folder_.root() / file, data, {.time = time});
        if (!is_again) to.add(time, file);
    };
    write(stent_, stent, "stent");
    write(wall_, wall, "wall");
}

}   // namespace patency
