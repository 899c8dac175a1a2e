// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/cell_vessel.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/base/parallel.h"
#include "patency/stages/cell_build.h"
#include "patency/stages/material.h"
#include "patency/stages/scene_sampling.h"
#include "patency/stages/vessel_results.h"

namespace patency {

std::unique_ptr<Scene> scene_of_cells(const CellScene& cells) {
    auto scene = std::make_unique<Scene>();
    scene->config = cells.config;
    scene->lumen = cells.lumen;
    scene->vessel = *cells.vessel;
    scene->estimate = estimate_flow(cells.config, *scene->vessel);
    scene->material = make_material(cells.config.blood);
    scene->numerics.spacing =
        largest_of(cells.mesh.size(), [&](std::size_t i) { return cells.spacing_at(cells.mesh.point[i]); });
    scene->spacing_at = cells.spacing_at;
    scene->numerics.reference_speed = cells.reference_speed;
    const double reach = 2 * scene->numerics.smoothing_ratio * scene->numerics.spacing;
    const Bounds box = grown(cells.lumen.bounds, 2 * reach);
    scene->frame = std::make_unique<Frame>(box.low, box.high, reach);

    place_cells(*scene, cells.mesh);
    set_flow(*scene, cells.balance->fields());
    scene->wall_parts = wall_parts_of(cells.mesh, *cells.balance);
    return scene;
}

void add_vessel_results(nlohmann::ordered_json& summary, const CellScene& cells, const OutputFolder& folder) {
    const auto scene = scene_of_cells(cells);
    VesselRecorder recorder(*scene);
    recorder.sample(*scene);
    const auto ends = cells.balance->end_states();
    const std::string& inlet = scene->vessel->openings.front().opening.name;
    double at_inlet = 0, lowest = INFINITY;
    for (std::size_t k = 0; k < ends.size(); ++k) {
        if (cells.lumen.openings[k].name == inlet)
            at_inlet = ends[k].pressure;
        else
            lowest = std::min(lowest, ends[k].pressure);
    }
    std::vector<double> out;
    for (const CellEndState& end : ends) out.push_back(end.flow);
    const VesselFlow flow = evaluate_vessel(*scene, recorder, at_inlet, lowest, out);
    add_vessel_summary(summary, *scene, recorder, flow);
    write_vessel_files(folder, *scene, recorder, flow);
}

}   // namespace patency
