// SPDX-License-Identifier: Apache-2.0
// From a case to a scene that is ready for its first step. Runs nothing.
#pragma once

#include <memory>

#include "patency/stages/scene.h"
#include "patency/stages/vessel.h"

namespace patency {

/// Lumen, openings, material, numbers, points fitted to the lumen, initial state and scheme of a case. Throws DeckError,
/// GeometryError, FileError.
std::unique_ptr<Scene> build_scene(const deck::Case& config);

/// The same without particles and scheme: what can be said before points are fitted.
/// `known`: as make_lumen's.
std::unique_ptr<Scene> build_frame(const deck::Case& config, const Vessel* known = nullptr);

/// How far blood is kept beyond an opening's plane [spacings]: the buffer.
inline constexpr double buffer_spacings = 4;

}   // namespace patency
