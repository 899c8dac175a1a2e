// SPDX-License-Identifier: Apache-2.0
#include "patency/io/checkpoint_block.h"

#include <fmt/format.h>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/io/hash.h"

namespace patency {
namespace {

constexpr std::string_view title = "patency checkpoint\n";

/// The rest of the line after KEY, or nothing.
std::string_view value_of(std::string_view block, std::string_view key) {
    const std::size_t at = block.find(key);
    if (at == block.npos) return {};
    block.remove_prefix(at + key.size());
    return block.substr(0, block.find('\n'));
}

}   // namespace

std::string make_checkpoint_block(std::string_view content) {
    std::string block = fmt::format("{}version {}\nbytes {}\nxxh64 {}\n", title, checkpoint_version,
                                    checkpoint_block_size + content.size(), hex_text(hash_bytes(content)));
    block.resize(checkpoint_block_size, '\n');
    return block;
}

std::string_view expect_checkpoint(std::string_view bytes, const std::filesystem::path& path) {
    const auto unfit = [&](const std::string& what) {
        return CheckpointError(fmt::format("the checkpoint '{}' {}. Start again with --fresh.", path.string(), what));
    };
    const std::string_view block = bytes.substr(0, checkpoint_block_size);
    if (!block.starts_with(title.substr(0, block.size())) || block.empty())
        throw unfit("is not a checkpoint of this program");
    if (block.size() < checkpoint_block_size)
        throw unfit(fmt::format("is truncated: it has only {} bytes", bytes.size()));
    const std::string_view content = bytes.substr(checkpoint_block_size);
    if (block == make_checkpoint_block(content)) return content;

    // Something is wrong; the rest finds the words for it.
    const std::string version = fmt::format("{}", checkpoint_version), size = fmt::format("{}", bytes.size());
    if (value_of(block, "\nversion ") != version)
        throw unfit(fmt::format("has format version {}, and this program reads version {}",
                                double_quoted(shortened(value_of(block, "\nversion "), 20)), version));
    if (value_of(block, "\nbytes ") != size)
        throw unfit(fmt::format("is truncated or extended: it has {} bytes and should have {}", size,
                                double_quoted(shortened(value_of(block, "\nbytes "), 20))));
    throw unfit("is damaged: its checksum is not that of its content");
}

}   // namespace patency
