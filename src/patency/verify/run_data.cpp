// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/run_data.h"

#include <nlohmann/json.hpp>

#include "patency/base/errors.h"

namespace patency {

using Json = nlohmann::ordered_json;

const std::vector<double>& RunData::list(const std::string& name) const {
    const auto found = lists.find(name);
    if (found == lists.end()) throw UsageError("the run has no list " + name);
    return found->second;
}

std::string format_run(const RunData& run) {
    Json j;
    j["key"] = run.key;
    j["failure"] = run.failure;
    j["particles"] = run.particles;
    j["acoustic_steps"] = run.acoustic_steps;
    j["particle_steps"] = run.particle_steps;
    j["cpu_s"] = run.cpu_s;
    j["wall_s"] = run.wall_s;
    j["lists"] = run.lists;
    return j.dump() + "\n";
}

std::optional<RunData> parse_run(const std::string& text) {
    try {
        const Json j = Json::parse(text);
        RunData run;
        run.key = j.at("key");
        run.failure = j.at("failure");
        run.particles = j.at("particles");
        run.acoustic_steps = j.at("acoustic_steps");
        run.particle_steps = j.at("particle_steps");
        run.cpu_s = j.at("cpu_s");
        run.wall_s = j.at("wall_s");
        run.lists = j.at("lists").get<std::map<std::string, std::vector<double>>>();
        return run;
    } catch (const Json::exception&) {
        return {};
    }
}

}   // namespace patency
