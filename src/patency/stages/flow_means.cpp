// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/flow_means.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/stages/lumen_of_case.h"
#include "patency/stages/outlet_summary.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

}   // namespace

void expect_finite(const Json& json, const std::string& path) {
    if (json.is_structured())
        for (const auto& [key, value] : json.items()) expect_finite(value, path.empty() ? key : path + "." + key);
    else if (json.is_number_float() && !std::isfinite(json.get<double>()))
        throw DivergedError(fmt::format("{} is not a finite number: the flow diverged", path));
}

FlowMark mark_flow(const Scene& scene) {
    FlowMark mark;
    mark.time = scene.time;
    for (const EndLaw& law : scene.laws) {
        mark.volume_out.push_back(law.volume_out);
        mark.pressure_time.push_back(law.pressure_time);
    }
    const FluidParticles& fluid = scene.fluid;
    const double stiffness = scene.material.density * scene.material.sound_speed * scene.material.sound_speed;
    if (scene.config.scheme() != deck::SchemeName::cells)   // which compress nothing
        mark.compressed =
            sum_of(fluid.size(),
                   [&](std::size_t i) { return fluid.opening[i] == 0 ? fluid.volume[i] * fluid.pressure[i] : 0.0; }) /
            stiffness;
    mark.inside = std::int64_t(sum_of(fluid.size(), [&](std::size_t i) { return fluid.opening[i] == 0 ? 1.0 : 0.0; }));
    return mark;
}

double window_start(const deck::Case& config) {
    const double end = config.numerics.duration;
    if (config.output.average_from) return *config.output.average_from;
    if (config.about.mode == deck::Mode::periodic && config.about.period)
        return std::max(0.0, end - *config.about.period);
    return 0.9 * end;
}

OpeningMean mean_between(const FlowMark& from, const FlowMark& to, std::size_t k, double area) {
    const double span = to.time - from.time;
    const double flow = (to.volume_out[k] - from.volume_out[k]) / span;
    return {flow, (to.pressure_time[k] - from.pressure_time[k]) / span, flow / area};
}

double mass_imbalance_percent(const FlowMark& from, const FlowMark& to) {
    double out = to.compressed - from.compressed, through = 0;
    for (std::size_t k = 0; k < to.volume_out.size(); ++k) {
        const double volume = to.volume_out[k] - from.volume_out[k];
        out += volume;
        through += 0.5 * std::abs(volume);
    }
    return through > 0 ? 100 * std::abs(out) / through : 0;
}

BulkValues bulk_values(const Scene& scene) {
    const FluidParticles& fluid = scene.fluid;
    const auto inside = [&](std::size_t i) { return fluid.opening[i] == 0; };
    const auto sum = [&](auto value) {
        return sum_of(fluid.size(), [&](std::size_t i) { return inside(i) ? fluid.volume[i] * value(i) : 0.0; });
    };
    const auto speed = [&](std::size_t i) { return norm(fluid.velocity[i]); };
    const double volume = sum([](std::size_t) { return 1.0; });
    return {.largest_speed = largest_of(fluid.size(), [&](std::size_t i) { return inside(i) ? speed(i) : 0.0; }),
            .mean_speed = sum(speed) / volume,
            .kinetic_energy = 0.5 * scene.material.density * sum([&](std::size_t i) { return speed(i) * speed(i); }),
            .mean_pressure = sum([&](std::size_t i) { return fluid.pressure[i]; }) / volume + scene.level()};
}

Json make_summary(const Scene& scene, const FlowMark& from) {
    const FlowMark to = mark_flow(scene);
    Json summary;
    summary["name"] = scene.config.about.name;
    summary["scheme"] = deck::word_of(scene.config.scheme());
    summary["precision"] = deck::word_of(scene.config.numerics.precision);
    summary["planar"] = scene.numerics.planar;
    summary["time_s"] = scene.time;
    summary["averaged_from_s"] = from.time;
    if (scene.config.about.mode == deck::Mode::periodic) summary["period_s"] = scene.config.about.period.value();
    summary["pressure_datum"] = scene.config.aorta.pressure ? "absolute" : "gauge";
    Json openings = Json::object();
    for (std::size_t k = 0; k < scene.ends.size() && to.time > from.time; ++k) {
        const OpeningMean mean = mean_between(from, to, k, scene.ends[k].area);
        openings[scene.ends[k].name] = {{"flow_m3_per_s", mean.flow},
                                        {"mean_pressure_pa", mean.pressure},
                                        {"mean_velocity_m_per_s", mean.velocity},
                                        {"area_m2", scene.ends[k].area}};
        add_outlet(openings[scene.ends[k].name], scene.config.openings.at(scene.ends[k].name), scene.datum);
    }
    summary["openings"] = openings;
    summary["gauge_pressure_ratio"] = nullptr;   // of a vessel with a lesion only (vessel_results.h)
    summary["ffr"] = {
        {"lesion", nullptr},
        {"reason", scene.config.aorta.pressure ? "a shape has no lesions" : "the deck gives no aortic pressure"}};
    summary["mass_imbalance_percent"] = mass_imbalance_percent(from, to);
    const bool is_on_cells = scene.config.scheme() == deck::SchemeName::cells;
    double finest = scene.numerics.spacing;
    if (scene.spacing_at)
        for (const Vec3& x : scene.fluid.position) finest = std::min(finest, scene.spacing_at(x));
    const BulkValues bulk = bulk_values(scene);
    summary["largest_speed_m_per_s"] = bulk.largest_speed;
    summary["mean_speed_m_per_s"] = bulk.mean_speed;
    summary["mean_pressure_pa"] = bulk.mean_pressure;
    summary["particles"] = {{"fluid", scene.fluid.size()},
                            {"inside", to.inside},
                            {"wall", scene.wall.size()},
                            {"across_narrowest", scene.lumen.narrowest / finest}};
    summary["spacing_m"] = finest;
    summary["reference_speed_m_per_s"] = scene.numerics.reference_speed;
    if (is_on_cells) {
        summary["acoustic_steps"] = 0;
        summary["time_steps"] = scene.advection_steps;
        summary["iterations"] = scene.acoustic_steps;
    } else {
        summary["sound_speed_m_per_s"] = scene.material.sound_speed;
        summary["acoustic_steps"] = scene.acoustic_steps;
        summary["advection_steps"] = scene.advection_steps;
    }
    expect_finite(summary, "");
    return summary;
}

}   // namespace patency
