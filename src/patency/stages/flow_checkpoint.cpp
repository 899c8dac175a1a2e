// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/flow_checkpoint.h"

#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/io/hash.h"
#include "patency/stages/build.h"
#include "patency/stages/cell_build.h"
#include "patency/stages/flow.h"
#include "patency/stages/scene_state.h"

namespace patency {

namespace {

std::vector<Vec3> places_of(const FluidParticles& fluid) { return {fluid.position.begin(), fluid.position.end()}; }

void write_mark(CheckpointWriter& writer, const std::string& name, const FlowMark& mark) {
    writer.write(name + "/time", mark.time);
    writer.write(name + "/volume_out", mark.volume_out);
    writer.write(name + "/pressure_time", mark.pressure_time);
    writer.write(name + "/compressed", mark.compressed);
    writer.write(name + "/inside", mark.inside);
}

FlowMark read_mark(const CheckpointReader& reader, const std::string& name) {
    return {.time = reader.read<double>(name + "/time"),
            .volume_out = reader.read<std::vector<double>>(name + "/volume_out"),
            .pressure_time = reader.read<std::vector<double>>(name + "/pressure_time"),
            .compressed = reader.read<double>(name + "/compressed"),
            .inside = reader.read<std::int64_t>(name + "/inside")};
}

void write_window(CheckpointWriter& writer, const FlowWindow::State& state) {
    if (state.begin) write_mark(writer, "window/begin", *state.begin);
    writer.write("window/marks", std::int64_t(state.marks.size()));
    for (std::size_t k = 0; k < state.marks.size(); ++k)
        write_mark(writer, "window/mark_" + std::to_string(k), state.marks[k]);
    writer.write("window/quiet_windows", std::int64_t(state.quiet_windows));
    writer.write("window/end", state.end);
    writer.write("window/change_percent", state.change_percent);
    writer.write("window/is_settled", std::int64_t(state.is_settled));
}

void write_means(CheckpointWriter& writer, const std::string& name, const VesselRecorder::State& means) {
    writer.write(name + "/flows", means.flows);
    writer.write(name + "/shear", means.shear);
    writer.write(name + "/pressure", means.pressure);
    writer.write(name + "/cut", means.cut);
}

VesselRecorder::State read_means(const CheckpointReader& reader, const std::string& name) {
    const auto numbers = [&](const char* what) { return reader.read<std::vector<double>>(name + what); };
    return {numbers("/flows"), numbers("/shear"), numbers("/pressure"), numbers("/cut")};
}

}   // namespace

CheckpointOrigin origin_of(const deck::Case& config, const std::string& binary_hash) {
    deck::Case alike = config;
    alike.numerics.threads = 0;
    CheckpointOrigin origin{.deck_hash = {}, .binary_hash = binary_hash, .input_hashes = {}};
    const auto take = [&](std::optional<std::filesystem::path>& file) {
        if (!file) return;
        std::string& hashes = origin.input_hashes[file->filename().string()];   // of all files of that name
        if (!hashes.empty()) hashes += ' ';
        hashes += hex_text(hash_file(*file));
        file = file->filename();   // where it lies is not what it holds
    };
    take(alike.geometry.surface);
    take(alike.geometry.network);
    if (alike.stent) take(alike.stent->surface);
    for (auto& [name, opening] : alike.openings)
        if (opening.waveform) take(opening.waveform->file);
    origin.deck_hash = hex_text(hash_bytes(deck::format_case(alike)));
    return origin;
}

nlohmann::ordered_json origin_summary(const CheckpointOrigin& origin) {
    nlohmann::ordered_json summary{{"inputs", nlohmann::ordered_json::object()}};
    for (const auto& [name, hash] : origin.input_hashes) summary["inputs"][name] = hash;
    summary["deck"] = origin.deck_hash;
    summary["program"] = origin.binary_hash;
    return summary;
}

void write_flow_checkpoint(const std::filesystem::path& path, const CheckpointOrigin& origin, const Scene& scene,
                           const FlowRecorder& recorder, const FlowWindow& window, const VesselRecorder* vessel) {
    CheckpointWriter writer(path, origin);
    writer.write(scene.fluid, "fluid");
    writer.write(scene.wall, "wall");
    const NamedNumbers numbers = numbers_of(scene);
    for (const auto& [name, values] : numbers.reals) writer.write("scene/" + name, values);
    for (const auto& [name, values] : numbers.integers) writer.write("scene/" + name, values);
    for (const auto& [name, values] : scene.scheme->state()) writer.write("scheme/" + name, values);
    const FlowRecorder::State state = recorder.state();
    writer.write("recorder/last_row", state.last_row);
    write_mark(writer, "recorder/row", state.row_mark);
    write_window(writer, window.state());
    if (vessel) {
        write_means(writer, "vessel", vessel->state());
        writer.write("vessel/blocks", std::int64_t(vessel->finished().size()));
        for (std::size_t k = 0; k < vessel->finished().size(); ++k)
            write_means(writer, "vessel/block_" + std::to_string(k), vessel->finished()[k]);
    }
    writer.finish();
}

std::unique_ptr<Scene> read_scene(const CheckpointReader& checkpoint, const deck::Case& config) {
    const bool is_on_cells = config.scheme() == deck::SchemeName::cells;
    auto scene = is_on_cells ? build_cell_frame(config) : build_frame(config);
    const std::vector<Vec3> cells = is_on_cells ? places_of(scene->fluid) : std::vector<Vec3>();
    checkpoint.read(scene->fluid, "fluid");
    checkpoint.read(scene->wall, "wall");
    if (is_on_cells && places_of(scene->fluid) != cells)
        throw CheckpointError(
            "The checkpoint is of other cells than this deck makes here; give --fresh to begin anew.");
    NamedNumbers numbers = numbers_of(*scene);   // for the names
    for (auto& [name, values] : numbers.reals) values = checkpoint.read<std::vector<double>>("scene/" + name);
    for (auto& [name, values] : numbers.integers) values = checkpoint.read<std::vector<std::int64_t>>("scene/" + name);
    restore_numbers(*scene, numbers);
    if (!is_on_cells) start_scheme(*scene);
    auto state = scene->scheme->state();   // for the names
    for (auto& [name, values] : state) values = checkpoint.read<std::vector<double>>("scheme/" + name);
    scene->scheme->restore(state);
    return scene;
}

void read_recorder(const CheckpointReader& checkpoint, FlowRecorder& recorder) {
    recorder.restore(
        {.last_row = checkpoint.read<double>("recorder/last_row"), .row_mark = read_mark(checkpoint, "recorder/row")});
}

void read_vessel_recorder(const CheckpointReader& checkpoint, VesselRecorder& vessel) {
    std::vector<VesselRecorder::State> finished;
    for (std::int64_t k = 0; k < checkpoint.read<std::int64_t>("vessel/blocks"); ++k)
        finished.push_back(read_means(checkpoint, "vessel/block_" + std::to_string(k)));
    vessel.restore(read_means(checkpoint, "vessel"), std::move(finished));
}

void read_window(const CheckpointReader& checkpoint, FlowWindow& window) {
    FlowWindow::State state;
    if (checkpoint.contains("window/begin/time")) state.begin = read_mark(checkpoint, "window/begin");
    for (std::int64_t k = 0; k < checkpoint.read<std::int64_t>("window/marks"); ++k)
        state.marks.push_back(read_mark(checkpoint, "window/mark_" + std::to_string(k)));
    state.end = checkpoint.read<double>("window/end");
    state.change_percent = checkpoint.read<double>("window/change_percent");
    state.quiet_windows = int(checkpoint.read<std::int64_t>("window/quiet_windows"));
    state.is_settled = checkpoint.read<std::int64_t>("window/is_settled") != 0;
    window.restore(state);
}

}   // namespace patency
