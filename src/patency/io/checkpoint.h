// SPDX-License-Identifier: Apache-2.0
// The state of a run on disk, bit for bit: an HDF5 file behind a block of 512 bytes with version, length
// and checksum of the whole file. Stores what it is given by name; what belongs to the state, and
// whether it fits the present deck, the stages decide.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "patency/particles/particle_set.h"

namespace patency {

/// What a checkpoint was made from. Resuming with anything else would not give the same bits.
struct CheckpointOrigin {
    std::string deck_hash, binary_hash;
    std::map<std::string, std::string> input_hashes;   ///< by file name; names have no line ends

    friend bool operator==(const CheckpointOrigin&, const CheckpointOrigin&) = default;
};

/// The kinds of named values beside particle sets.
template <class T>
concept CheckpointValue = std::same_as<T, double> || std::same_as<T, std::int64_t> || std::same_as<T, std::string> ||
    std::same_as<T, std::vector<double>> || std::same_as<T, std::vector<std::int64_t>> ||
    std::same_as<T, std::vector<std::byte>>;

/// Collects a checkpoint in memory and puts it in place as a whole: until finish() returns, the previous
/// file stays. Names are paths: "ends/outlet_1/pressure"; each is written once. The file is a function of
/// what was written and in which order: no dates, no machine.
class CheckpointWriter {
public:
    CheckpointWriter(const std::filesystem::path& path, const CheckpointOrigin& origin);
    ~CheckpointWriter();   // without finish(): nothing happens on disk

    /// Every field with Keep::state, in array order. A value that is not finite is refused with
    /// DivergedError naming field and particle: the last good checkpoint stays.
    void write(const ParticleSet& particles, std::string_view name);
    /// One value, stored bit for bit whatever it is.
    template <CheckpointValue T>
    void write(std::string_view name, const T& value);

    /// Write, flush to the disk, rename. Throws FileError. Once, as the last call.
    void finish();

private:
    struct File;
    std::unique_ptr<File> file_;
    std::filesystem::path path_;
};

/// A checkpoint read into memory. The constructor throws FileError when the file cannot be read, and
/// CheckpointError when it is no checkpoint, of another version, truncated or damaged in any byte.
class CheckpointReader {
public:
    explicit CheckpointReader(const std::filesystem::path& path);
    ~CheckpointReader();

    const CheckpointOrigin& origin() const { return origin_; }
    /// CheckpointError, saying what changed, unless the checkpoint was made from the same.
    void expect_origin(const CheckpointOrigin& present) const;

    /// Resize the set and fill every field with Keep::state. A field that is missing, of another kind or
    /// unit, or left over is a CheckpointError naming it, and the set stays as it was.
    void read(ParticleSet& particles, std::string_view name) const;
    /// CheckpointError if there is no value of that name and kind.
    template <CheckpointValue T>
    T read(std::string_view name) const;
    bool contains(std::string_view name) const;

private:
    struct File;
    std::unique_ptr<File> file_;
    std::filesystem::path path_;
    CheckpointOrigin origin_;
};

}   // namespace patency
