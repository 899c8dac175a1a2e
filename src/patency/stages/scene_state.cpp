// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/scene_state.h"

#include <fmt/format.h>

#include "patency/base/errors.h"

namespace patency {

namespace {

/// Visits every number once, for both directions: what is written is what is read.
template <class SceneType, class Visit>
void for_each_number(SceneType& scene, Visit visit) {
    visit("time", scene.time);
    visit("reference_pressure", scene.reference_pressure);
    visit("last_dt", scene.last_dt);
    visit("excess_divergence", scene.fluid.excess_divergence);
    visit("acoustic_steps", scene.acoustic_steps);
    visit("advection_steps", scene.advection_steps);
    for (std::size_t k = 0; k < scene.ends.size(); ++k) {
        auto& end = scene.ends[k];
        auto& law = scene.laws[k];
        visit("end_buffer_length", end.buffer_length);
        visit("end_pressure", end.pressure);
        visit("end_resistance", end.resistance);
        visit("end_flow", end.flow);
        visit("end_flow_excess", end.flow_excess);
        visit("end_entrance_excess", end.entrance_excess);
        visit("end_mean_pressure", end.mean_pressure);
        visit("end_slope", end.slope);
        visit("end_sound_mean", end.absorber.mean);
        visit("end_sound_let_out", end.absorber.let_out);
        visit("end_crossed", end.crossed);
        visit("end_crossed_volume", end.crossed_volume);
        visit("law_state_0", law.state[0]);
        visit("law_state_1", law.state[1]);
        visit("law_known_until", law.known_until);
        visit("law_known_flow", law.known_flow);
        visit("law_known_pressure", law.known_pressure);
        visit("law_is_started", law.is_started);
        visit("law_level_state_0", law.level_state[0]);
        visit("law_level_state_1", law.level_state[1]);
        visit("law_level_flow", law.level_flow);
        visit("law_volume_out", law.volume_out);
        visit("law_pressure_time", law.pressure_time);
    }
}

struct Writer {
    NamedNumbers& to;
    void operator()(const char* name, double value) const { to.reals[name].push_back(value); }
    void operator()(const char* name, std::int64_t value) const { to.integers[name].push_back(value); }
    void operator()(const char* name, bool value) const { to.integers[name].push_back(value); }
};

class Reader {
public:
    explicit Reader(const NamedNumbers& from) : from_(from) {}
    void operator()(const char* name, double& value) { value = next(from_.reals, name); }
    void operator()(const char* name, std::int64_t& value) { value = next(from_.integers, name); }
    void operator()(const char* name, bool& value) { value = next(from_.integers, name) != 0; }

    void expect_all_read() const {
        const auto check = [&](const auto& map) {
            for (const auto& [name, values] : map) {
                const auto read = read_.find(name);
                if (read == read_.end() || read->second != values.size())
                    throw CheckpointError(fmt::format("the checkpoint has more of '{}' than the case", name));
            }
        };
        check(from_.reals);
        check(from_.integers);
    }

private:
    template <class Map>
    typename Map::mapped_type::value_type next(const Map& map, const char* name) {
        const std::size_t k = read_[name]++;
        const auto found = map.find(name);
        if (found == map.end() || k >= found->second.size())
            throw CheckpointError(
                fmt::format("the checkpoint has no '{}' number {}: it is not of this case", name, k + 1));
        return found->second[k];
    }
    const NamedNumbers& from_;
    std::map<std::string, std::size_t> read_;
};

}   // namespace

NamedNumbers numbers_of(const Scene& scene) {
    NamedNumbers numbers;
    for_each_number(scene, Writer{numbers});
    return numbers;
}

void restore_numbers(Scene& scene, const NamedNumbers& numbers) {
    Reader reader(numbers);
    for_each_number(scene, [&](const char* name, auto& value) { reader(name, value); });
    reader.expect_all_read();
}

}   // namespace patency
