// SPDX-License-Identifier: Apache-2.0
// An HDF5 file in memory, as far as checkpoints need it. The disk's errors then appear in one place,
// atomic_file, and a hostile file is checked before the HDF5 library parses it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace patency::hdf5 {

/// Owns an identifier of the library: its hid_t, without its header.
class Id {
public:
    using Close = int (*)(std::int64_t);
    /// Throws CheckpointError, as all that follows, for the negative ids with which HDF5 reports errors.
    Id(std::int64_t id, Close close, std::string_view what);
    Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Id& operator=(Id&&) = delete;
    ~Id() {
        if (id_ >= 0) close_(id_);
    }
    operator std::int64_t() const { return id_; }

private:
    std::int64_t id_;
    Close close_;
};

/// The kind of one number or text in a file; the same in memory, so nothing is ever converted.
enum class Kind { float64, int32, int64, byte, text };

using Extent = unsigned long long;   // the library's hsize_t

/// A dataset's kind and shape; no dimensions: one value. Text has one dimension, its length.
struct Form {
    Kind kind;
    std::vector<Extent> shape;
    friend bool operator==(const Form&, const Form&) = default;

    std::size_t size() const;   ///< bytes
};

Id make_image();
/// Copies the bytes.
Id open_image(std::string_view bytes);
/// The file's bytes so far.
std::string image_of(const Id& file);

/// Makes the groups on the way. A name that is taken is an error.
void write_dataset(const Id& file, const std::string& name, const Form& form, std::span<const std::byte> bytes);
/// An attribute of an existing dataset.
void write_text_attribute(const Id& file, const std::string& dataset, const std::string& name, const std::string& text);
void make_group(const Id& file, const std::string& name);

bool contains(const Id& file, const std::string& name);
Form form_of(const Id& file, const std::string& dataset);
/// `bytes` has form_of(dataset).size() bytes.
void read_dataset(const Id& file, const std::string& dataset, std::span<std::byte> bytes);
std::string read_text_attribute(const Id& file, const std::string& dataset, const std::string& name);
/// What a group holds, by name.
std::vector<std::string> names_in(const Id& file, const std::string& group);

}   // namespace patency::hdf5
