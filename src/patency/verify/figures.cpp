// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/figures.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/base/errors.h"

namespace patency {

using Json = nlohmann::ordered_json;

bool Figure::passes() const {
    if (!value) return false;
    return !bar || (bar->sense == Sense::at_most ? *value <= bar->limit : *value >= bar->limit);
}

bool CaseReport::passes() const {
    return std::all_of(figures.begin(), figures.end(), [](const Figure& f) { return f.passes(); });
}

std::string word_of(Level level) { return level == Level::quick ? "quick" : "full"; }
std::string word_of(Sense sense) { return sense == Sense::at_most ? "<=" : ">="; }

std::string format_report(const CaseReport& report) {
    Json figures = Json::array();
    for (const Figure& f : report.figures) {
        if (f.value && !std::isfinite(*f.value))
            throw DivergedError("verification case " + report.name + ": " + f.key + " is not a number");
        Json j;
        j["key"] = f.key;
        j["value"] = f.value ? Json(*f.value) : Json();
        j["unit"] = f.unit;
        j["bar"] = f.bar ? Json(f.bar->limit) : Json();
        j["sense"] = f.bar ? Json(word_of(f.bar->sense)) : Json();
        j["pass"] = f.passes();
        if (!f.value) j["reason"] = f.reason;
        figures.push_back(j);
    }
    return Json({{"name", report.name},
                 {"level", word_of(report.level)},
                 {"particles", report.particles},
                 {"figures", figures}})
               .dump(1) +
           "\n";
}

CaseReport parse_report(const std::string& text, const std::string& source) {
    try {
        const Json j = Json::parse(text);
        CaseReport report;
        report.name = j.at("name");
        report.level = j.at("level") == "full" ? Level::full : Level::quick;
        report.particles = j.at("particles");
        for (const Json& f : j.at("figures")) {
            Figure figure{
                .key = f.at("key"), .value = {}, .unit = f.at("unit"), .bar = {}, .reason = f.value("reason", "")};
            if (!f.at("value").is_null()) figure.value = f.at("value").get<double>();
            if (!f.at("bar").is_null())
                figure.bar = Bar{f.at("bar"), f.at("sense") == "<=" ? Sense::at_most : Sense::at_least};
            report.figures.push_back(figure);
        }
        return report;
    } catch (const Json::exception& error) {
        throw FileError(source + " is not the report of a verification case: " + error.what());
    }
}

}   // namespace patency
