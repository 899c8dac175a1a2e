// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/flow_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/stages/scene_sampling.h"

namespace patency {

namespace {

// Rows of waveforms and probes over a run: enough for twenty harmonics of a dozen heart beats, little to read.
constexpr double rows_per_run = 2000;

std::string flow_unit(const Scene& scene) { return scene.numerics.planar ? "m2_per_s" : "m3_per_s"; }

/// On the wall counts as inside: profiles end there.
bool is_in_blood(const Scene& scene, const Vec3& x) {
    return scene.lumen.distance.value(x) <= 1e-6 * scene.numerics.spacing && opening_beyond(scene.lumen, x) < 0;
}

std::vector<FlowSample> sample_scene(const Scene& scene, std::span<const Vec3> places) {
    const WallHint wall = wall_hint(scene);
    // A wall that slides or lets the blood slip says nothing of the velocity beside it that is worth the trouble.
    return sample_flow(scene.fluid, *scene.frame, places, sampling_reach(scene), scene.numerics.planar,
                       wall_sticks(scene) ? &wall : nullptr);
}

std::vector<Vec3> places_of(const Scene& scene, const deck::LineProfile& profile) {
    std::vector<Vec3> places = places_along(profile.from, profile.to, profile.points);
    std::erase_if(places, [&](const Vec3& x) { return !is_in_blood(scene, x); });
    return places;
}

}   // namespace

FlowRecorder::FlowRecorder(const Scene& scene) : row_mark_(mark_flow(scene)) {
    const deck::Case& config = scene.config;
    row_interval_ = config.numerics.duration / rows_per_run;
    if (!scene.ends.empty()) {
        RecordedTable waveforms{"waveforms", {"time_s"}};
        for (const OpenEnd& end : scene.ends) {
            waveforms.columns.push_back(fmt::format("{}_flow_{}", end.name, flow_unit(scene)));
            waveforms.columns.push_back(fmt::format("{}_mean_pressure_pa", end.name));
        }
        tables_.push_back(std::move(waveforms));
    }
    if (!config.output.probes.empty()) {
        RecordedTable probes{"probes", {"time_s"}};
        for (const deck::Probe& probe : config.output.probes) {
            if (!is_in_blood(scene, probe.point))
                throw DeckError(fmt::format("output.probes: {} lies outside the blood, {:.3g} mm from the wall",
                                            probe.name, 1e3 * std::abs(scene.lumen.distance.value(probe.point))));
            for (const char* what : {"velocity_x_m_per_s", "velocity_y_m_per_s", "velocity_z_m_per_s", "pressure_pa"})
                probes.columns.push_back(probe.name + "_" + what);
        }
        tables_.push_back(std::move(probes));
    }
    first_profile_ = tables_.size();
    for (const deck::LineProfile& profile : config.output.profiles) {
        if (places_of(scene, profile).empty())
            throw DeckError(fmt::format("output.profiles: no point of {} lies in the blood", profile.name));
        exact_times_.insert(exact_times_.end(), profile.times.begin(), profile.times.end());
        tables_.push_back({"profile_" + profile.name,
                           {"time_s", "distance_m", "x_m", "y_m", "z_m", "velocity_x_m_per_s", "velocity_y_m_per_s",
                            "velocity_z_m_per_s", "pressure_pa"}});
    }
    std::sort(exact_times_.begin(), exact_times_.end());
}

void FlowRecorder::begin(const Scene& scene) {
    const auto& profiles = scene.config.output.profiles;
    for (std::size_t k = 0; k < profiles.size(); ++k)
        if (std::find(profiles[k].times.begin(), profiles[k].times.end(), scene.time) != profiles[k].times.end())
            write_profile(scene, k);
}

double FlowRecorder::last_row_of(std::size_t table, double now) const {
    return table < first_profile_ ? last_row_ : now;
}

void FlowRecorder::observe(const Scene& scene, bool is_end) {
    // Counted in whole intervals, so that an interrupted run writes the same rows.
    if (std::floor(scene.time / row_interval_) > std::floor(last_row_ / row_interval_) || is_end) {
        write_waveforms(scene);
        write_probes(scene);
        last_row_ = scene.time;
        row_mark_ = mark_flow(scene);
    }
    const auto& profiles = scene.config.output.profiles;
    for (std::size_t k = 0; k < profiles.size(); ++k) {
        const auto& times = profiles[k].times;
        if (times.empty() ? is_end : std::find(times.begin(), times.end(), scene.time) != times.end())
            write_profile(scene, k);
    }
}

void FlowRecorder::write_waveforms(const Scene& scene) {
    if (scene.ends.empty() || !write_row) return;
    const FlowMark now = mark_flow(scene);
    std::vector<double> row{0.5 * (row_mark_.time + now.time)};   // of a mean: the middle of its interval
    for (std::size_t k = 0; k < scene.ends.size(); ++k) {
        const OpeningMean mean = mean_between(row_mark_, now, k, scene.ends[k].area);
        row.push_back(mean.flow);
        row.push_back(mean.pressure);
    }
    write_row(0, row);
}

void FlowRecorder::write_probes(const Scene& scene) {
    if (scene.config.output.probes.empty() || !write_row) return;
    std::vector<double> row{scene.time};
    for (const deck::Probe& probe : scene.config.output.probes) {   // one by one: they may lie far apart
        const FlowSample sample = sample_scene(scene, {&probe.point, 1}).front();
        for (const double value :
             {sample.velocity.x, sample.velocity.y, sample.velocity.z, sample.pressure + scene.level()})
            row.push_back(value);
    }
    write_row(scene.ends.empty() ? 0 : 1, row);
}

void FlowRecorder::write_profile(const Scene& scene, std::size_t k) {
    if (!write_row) return;
    const deck::LineProfile& profile = scene.config.output.profiles[k];
    const std::vector<Vec3> places = places_of(scene, profile);
    const std::vector<FlowSample> samples = sample_scene(scene, places);
    for (std::size_t p = 0; p < places.size(); ++p) {
        const Vec3 &x = places[p], &v = samples[p].velocity;
        const double row[] = {
            scene.time, norm(x - profile.from), x.x, x.y, x.z, v.x, v.y, v.z, samples[p].pressure + scene.level()};
        write_row(first_profile_ + k, row);
    }
}

void FlowRecorder::restore(const State& state) {
    last_row_ = state.last_row;
    row_mark_ = state.row_mark;
}

}   // namespace patency
