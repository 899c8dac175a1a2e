// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_doubts.h"

#include <nlohmann/json.hpp>

#include "patency/analysis/stent_metrics.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

double number(const Json& deploy, const char* key, double where_unknown) {
    return deploy.contains(key) && deploy[key].is_number() ? deploy[key].get<double>() : where_unknown;
}

}   // namespace

std::vector<std::string> doubts_about(const Json& deploy) {
    std::vector<std::string> doubts;
    if (!(number(deploy, "opened_over_wanted", 1) >= least_opened))
        doubts.push_back(
            "the stent was not opened to the wanted diameter; give deployment.load more, or look for what holds it");
    if (!(number(deploy, "kinetic_to_internal", 0) < most_kinetic_to_internal))
        doubts.push_back(
            "the deployment was not quasi-static: its kinetic energy rose above a twentieth of the internal one, so "
            "that recoil, strains and pressures are provisional; give deployment.steps more, or deployment.slowing");
    if (!(number(deploy, "drift_percent", 0) < most_drift_percent))
        doubts.push_back(
            "the stent was still moving when its time was over, so that recoil and diameters are provisional; give "
            "deployment.steps more");
    return doubts;
}

}   // namespace patency
