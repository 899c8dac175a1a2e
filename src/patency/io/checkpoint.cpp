// SPDX-License-Identifier: Apache-2.0
#include "patency/io/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/io/atomic_file.h"
#include "patency/io/checkpoint_block.h"
#include "patency/io/hdf5_image.h"

namespace patency {
namespace {

using hdf5::Form;
using hdf5::Kind;

// Three roots, so that no name of a caller meets another's.
std::string particles_name(std::string_view name) { return fmt::format("particles/{}", name); }
std::string value_name(std::string_view name) { return fmt::format("values/{}", name); }
constexpr const char* origin_name = "origin";

template <class T>
constexpr bool is_list = requires(T t) {
    t.data();
};

template <class T>
constexpr Kind kind_for() {
    if constexpr (std::is_same_v<T, std::string>)
        return Kind::text;
    else if constexpr (is_list<T>)
        return kind_for<typename T::value_type>();
    else
        return std::is_same_v<T, double> ? Kind::float64 : std::is_same_v<T, std::int64_t> ? Kind::int64 : Kind::byte;
}

std::string_view text_of(Kind kind) {
    switch (kind) {
        case Kind::float64: return "numbers";
        case Kind::int32:
        case Kind::int64: return "integers";
        case Kind::byte: return "bytes";
        case Kind::text: return "text";
    }
    return "";
}

Form form_of(const FieldBase& field, std::size_t count) {
    Form form{field.is_integer() ? Kind::int32 : Kind::float64, {count}};
    if (field.components() > 1) form.shape.push_back(hdf5::Extent(field.components()));
    return form;
}

/// The hashes as lines "HASH NAME", deck and binary first.
std::string text_of(const CheckpointOrigin& origin) {
    std::string text = fmt::format("{} deck\n{} binary\n", origin.deck_hash, origin.binary_hash);
    for (const auto& [name, hash] : origin.input_hashes) text += fmt::format("{} {}\n", hash, name);
    return text;
}

CheckpointOrigin origin_from(std::string_view text) {
    CheckpointOrigin origin;
    for (int line = 0; !text.empty(); ++line) {
        const std::string_view entry = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(entry.size() + 1, text.size()));
        const std::size_t blank = std::min(entry.find(' '), entry.size());
        const std::string hash(entry.substr(0, blank)), name(entry.substr(std::min(blank + 1, entry.size())));
        if (line == 0)
            origin.deck_hash = hash;
        else if (line == 1)
            origin.binary_hash = hash;
        else
            origin.input_hashes[name] = hash;
    }
    return origin;
}

void expect_finite(const FieldBase& field, std::string_view set) {
    if (field.is_integer()) return;
    const std::span<const std::byte> bytes = field.bytes();
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(double)) {
        double value;
        std::memcpy(&value, &bytes[i], sizeof value);
        if (!std::isfinite(value))
            throw DivergedError(
                fmt::format("{} of {} particle {} is {}: the computation has left the realm of numbers; the "
                            "checkpoint before it is kept.",
                            field.name(), set, i / sizeof(double) / std::size_t(field.components()), value));
    }
}

}   // namespace

struct CheckpointWriter::File {
    hdf5::Id image = hdf5::make_image();
};

CheckpointWriter::CheckpointWriter(const std::filesystem::path& path, const CheckpointOrigin& origin)
    : file_(std::make_unique<File>()), path_(path) {
    const std::string text = text_of(origin);
    hdf5::write_dataset(file_->image, origin_name, {Kind::text, {text.size()}}, std::as_bytes(std::span(text)));
}

CheckpointWriter::~CheckpointWriter() = default;

void CheckpointWriter::write(const ParticleSet& particles, std::string_view name) {
    const std::string group = particles_name(name);
    hdf5::make_group(file_->image, group);
    for (const FieldBase* field : particles.fields()) {
        if (field->keep() != Keep::state) continue;
        expect_finite(*field, name);
        const std::string dataset = group + "/" + field->name();
        hdf5::write_dataset(file_->image, dataset, form_of(*field, particles.size()), field->bytes());
        hdf5::write_text_attribute(file_->image, dataset, "unit", field->unit());
    }
}

template <CheckpointValue T>
void CheckpointWriter::write(std::string_view name, const T& value) {
    if constexpr (is_list<T>)
        hdf5::write_dataset(file_->image, value_name(name), {kind_for<T>(), {value.size()}},
                            std::as_bytes(std::span(value)));
    else
        hdf5::write_dataset(file_->image, value_name(name), {kind_for<T>(), {}}, std::as_bytes(std::span(&value, 1)));
}

void CheckpointWriter::finish() {
    assert(file_ && "a checkpoint is finished once");
    const std::string image = hdf5::image_of(file_->image);
    file_.reset();   // before the disk is busy: its memory is needed no more
    write_file(path_, {make_checkpoint_block(image), image});
}

struct CheckpointReader::File {
    hdf5::Id image;
};

CheckpointReader::CheckpointReader(const std::filesystem::path& path) : path_(path) {
    const std::string bytes = read_file(path);
    const std::string_view content = expect_checkpoint(bytes, path);
    file_ = std::make_unique<File>(File{hdf5::open_image(content)});
    std::string text(hdf5::form_of(file_->image, origin_name).size(), '\0');
    hdf5::read_dataset(file_->image, origin_name, std::as_writable_bytes(std::span(text)));
    origin_ = origin_from(text);
}

CheckpointReader::~CheckpointReader() = default;

void CheckpointReader::expect_origin(const CheckpointOrigin& present) const {
    std::vector<std::string> changes;
    if (present.deck_hash != origin_.deck_hash) changes.push_back("the deck");
    if (present.binary_hash != origin_.binary_hash) changes.push_back("the program");
    for (const auto& [name, hash] : present.input_hashes) {
        const auto stored = origin_.input_hashes.find(name);
        if (stored == origin_.input_hashes.end())
            changes.push_back(fmt::format("'{}' (new)", name));
        else if (stored->second != hash)
            changes.push_back(fmt::format("'{}'", name));
    }
    for (const auto& [name, hash] : origin_.input_hashes)
        if (!present.input_hashes.contains(name)) changes.push_back(fmt::format("'{}' (no longer used)", name));
    if (changes.empty()) return;
    throw CheckpointError(
        fmt::format("the checkpoint '{}' does not fit, since these have changed: {}. Put them back as they "
                    "were, begin anew with --fresh, or choose another folder.",
                    path_.string(), join(changes, ", ", " and ")));
}

void CheckpointReader::read(ParticleSet& particles, std::string_view name) const {
    const auto unfit = [&](const std::string& what) {
        return CheckpointError(fmt::format("the checkpoint '{}' does not fit: {}.", path_.string(), what));
    };
    const hdf5::Id& image = file_->image;
    const std::string group = particles_name(name);
    if (!hdf5::contains(image, group)) throw unfit(fmt::format("it has no particles '{}'", name));

    // Everything is compared before anything is changed.
    std::size_t count = 0;
    bool is_first = true;
    std::vector<std::string> left_over = hdf5::names_in(image, group);
    for (const FieldBase* field : particles.fields()) {
        if (field->keep() != Keep::state) continue;
        if (std::erase(left_over, field->name()) == 0)
            throw unfit(fmt::format("{} has no field '{}'", name, field->name()));
        const std::string dataset = group + "/" + field->name();
        const Form stored = hdf5::form_of(image, dataset);
        if (std::exchange(is_first, false)) count = stored.shape.empty() ? 0 : stored.shape[0];
        if (stored != form_of(*field, count))
            throw unfit(fmt::format("field '{}' of {} has another shape or kind of number", field->name(), name));
        if (const std::string unit = hdf5::read_text_attribute(image, dataset, "unit"); unit != field->unit())
            throw unfit(
                fmt::format("field '{}' of {} is in '{}', not in '{}'", field->name(), name, unit, field->unit()));
    }
    if (!left_over.empty())
        throw unfit(fmt::format("{} has a field '{}' that nothing here uses", name, left_over.front()));

    particles.resize(count);
    for (FieldBase* field : particles.fields())
        if (field->keep() == Keep::state) hdf5::read_dataset(image, group + "/" + field->name(), field->bytes());
}

template <CheckpointValue T>
T CheckpointReader::read(std::string_view name) const {
    const std::string dataset = value_name(name);
    if (!contains(name))
        throw CheckpointError(
            fmt::format("the checkpoint '{}' does not fit: it has no value '{}'.", path_.string(), name));
    const Form form = hdf5::form_of(file_->image, dataset);
    if (form.kind != kind_for<T>() || form.shape.size() != (is_list<T> ? 1 : 0))
        throw CheckpointError(fmt::format("the checkpoint '{}' does not fit: '{}' is not {} {}.", path_.string(), name,
                                          is_list<T> ? "a list of" : "one of", text_of(kind_for<T>())));
    T value{};
    if constexpr (is_list<T>) {
        value.resize(form.shape[0]);
        hdf5::read_dataset(file_->image, dataset, std::as_writable_bytes(std::span(value)));
    } else {
        hdf5::read_dataset(file_->image, dataset, std::as_writable_bytes(std::span(&value, 1)));
    }
    return value;
}

bool CheckpointReader::contains(std::string_view name) const { return hdf5::contains(file_->image, value_name(name)); }

template void CheckpointWriter::write(std::string_view, const double&);
template void CheckpointWriter::write(std::string_view, const std::int64_t&);
template void CheckpointWriter::write(std::string_view, const std::string&);
template void CheckpointWriter::write(std::string_view, const std::vector<double>&);
template void CheckpointWriter::write(std::string_view, const std::vector<std::int64_t>&);
template void CheckpointWriter::write(std::string_view, const std::vector<std::byte>&);
template double CheckpointReader::read(std::string_view) const;
template std::int64_t CheckpointReader::read(std::string_view) const;
template std::string CheckpointReader::read(std::string_view) const;
template std::vector<double> CheckpointReader::read(std::string_view) const;
template std::vector<std::int64_t> CheckpointReader::read(std::string_view) const;
template std::vector<std::byte> CheckpointReader::read(std::string_view) const;

}   // namespace patency
