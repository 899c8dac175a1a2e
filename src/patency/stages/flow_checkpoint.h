// SPDX-License-Identifier: Apache-2.0
// A flow stage on disk and back: particles, numbers of the scene, marks of the recorder.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "patency/io/checkpoint.h"
#include "patency/stages/flow_recorder.h"
#include "patency/stages/flow_window.h"
#include "patency/stages/scene.h"
#include "patency/stages/vessel_recorder.h"

namespace patency {

/// What a flow is made from: the deck (threads apart, which change no bit), the files it names, the program.
CheckpointOrigin origin_of(const deck::Case& config, const std::string& binary_hash);
/// The same for summary.json.
nlohmann::ordered_json origin_summary(const CheckpointOrigin& origin);

/// Throws FileError; DivergedError if a value is not finite: the last good checkpoint stays.
void write_flow_checkpoint(const std::filesystem::path& path, const CheckpointOrigin& origin, const Scene& scene,
                           const FlowRecorder& recorder, const FlowWindow& window,
                           const VesselRecorder* vessel = nullptr);

/// A scene of the case, ready for its next step, as the checkpoint left it. Throws FileError, CheckpointError.
std::unique_ptr<Scene> read_scene(const CheckpointReader& checkpoint, const deck::Case& config);
/// What the recorder and the window of that scene stood at.
void read_recorder(const CheckpointReader& checkpoint, FlowRecorder& recorder);
void read_window(const CheckpointReader& checkpoint, FlowWindow& window);
void read_vessel_recorder(const CheckpointReader& checkpoint, VesselRecorder& vessel);

}   // namespace patency
