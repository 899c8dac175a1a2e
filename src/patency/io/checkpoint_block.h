// SPDX-License-Identifier: Apache-2.0
// The first 512 bytes of a checkpoint, legible with `head -4`. HDF5 tools skip them: the format looks for
// its own beginning at byte 512 too.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patency {

constexpr int checkpoint_version = 1;
constexpr std::size_t checkpoint_block_size = 512;

/// The block that belongs in front of these bytes.
std::string make_checkpoint_block(std::string_view content);

/// The content of a checkpoint's bytes. CheckpointError, naming the path, unless the block is exactly the
/// one that belongs in front of it: so a flip of any bit of the file is noticed before HDF5 sees it.
std::string_view expect_checkpoint(std::string_view bytes, const std::filesystem::path& path);

}   // namespace patency
