// SPDX-License-Identifier: Apache-2.0
#include "patency/io/summary.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"

namespace patency {
namespace {

using Json = nlohmann::ordered_json;

void expect_finite(const Json& value, const std::string& key, const std::filesystem::path& path) {
    if (value.is_number_float() && !std::isfinite(value.get<double>()))
        throw DivergedError(fmt::format("{} of {} would go into '{}': the computation has left the realm of numbers.",
                                        value.get<double>(), key.empty() ? "the document" : key, path.string()));
    const std::string prefix = key.empty() ? key : key + ".";
    if (value.is_object())
        for (const auto& [name, member] : value.items()) expect_finite(member, prefix + name, path);
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) expect_finite(value[i], fmt::format("{}[{}]", key, i), path);
}

}   // namespace

void write_summary(const std::filesystem::path& path, const Json& document) {
    expect_finite(document, "", path);
    // File names need not be UTF-8; a strange letter in one must not cost the results.
    write_file(path, document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Json read_summary(const std::filesystem::path& path) {
    Json document = Json::parse(read_file(path), nullptr, false);
    if (document.is_discarded())
        throw FileError(fmt::format("cannot read '{}': it is not a JSON document.", path.string()));
    return document;
}

}   // namespace patency
