// SPDX-License-Identifier: Apache-2.0
#include "patency/io/pvd.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"

namespace patency {
namespace {

constexpr std::pair<char, std::string_view> entities[] = {
    {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};

std::string escaped(std::string_view text) {
    std::string out;
    for (char c : text) {
        std::string_view piece(&c, 1);
        for (const auto& [character, entity] : entities)
            if (c == character) piece = entity;
        out += piece;
    }
    return out;
}

std::string unescaped(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        std::size_t taken = 1;
        char c = text.front();
        for (const auto& [character, entity] : entities)
            if (text.starts_with(entity)) c = character, taken = entity.size();
        out += c;
        text.remove_prefix(taken);
    }
    return out;
}

/// The value of NAME="value" in one line of the collection.
std::optional<std::string> attribute(std::string_view line, std::string_view name) {
    const std::string start = fmt::format(" {}=\"", name);
    const std::size_t first = line.find(start);
    if (first == line.npos) return std::nullopt;
    line.remove_prefix(first + start.size());
    const std::size_t end = line.find('"');
    if (end == line.npos) return std::nullopt;
    return unescaped(line.substr(0, end));
}

}   // namespace

std::vector<PvdFrame> read_pvd(const std::filesystem::path& path) {
    const std::string contents = read_file(path);
    const FileError wrong(fmt::format(
        "cannot read '{}': it is not a collection of frames of this program. Move it away.", path.string()));
    if (contents.find("<Collection>") == contents.npos || contents.find("</Collection>") == contents.npos) throw wrong;
    std::vector<PvdFrame> frames;
    for (std::size_t at = contents.find("<DataSet"); at != contents.npos; at = contents.find("<DataSet", at + 1)) {
        const std::string_view element = std::string_view(contents).substr(at, contents.find('>', at) - at);
        const auto time_text = attribute(element, "timestep"), file = attribute(element, "file");
        if (!time_text || !file) throw wrong;
        double time = 0;
        const char* const end = time_text->data() + time_text->size();
        if (const auto result = std::from_chars(time_text->data(), end, time);
            result.ec != std::errc{} || result.ptr != end)
            throw wrong;
        frames.push_back({time, *file});
    }
    return frames;
}

PvdWriter::PvdWriter(const std::filesystem::path& path) : PvdWriter(path, std::vector<PvdFrame>{}) {}

PvdWriter::PvdWriter(const std::filesystem::path& path, std::vector<PvdFrame> frames)
    : path_(path), frames_(std::move(frames)) {
    write();
}

PvdWriter PvdWriter::resumed(const std::filesystem::path& path, double last_time) {
    if (!std::filesystem::exists(path)) return PvdWriter(path);
    std::vector<PvdFrame> frames = read_pvd(path);
    const auto is_late = [&](const PvdFrame& frame) { return frame.time > last_time; };
    frames.erase(std::find_if(frames.begin(), frames.end(), is_late), frames.end());
    return PvdWriter(path, std::move(frames));
}

void PvdWriter::add(double time, const std::filesystem::path& file) {
    frames_.push_back({time, file.generic_string()});
    write();
}

void PvdWriter::write() const {
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
    for (const PvdFrame& frame : frames_)
        text += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", frame.time, escaped(frame.file));
    text += "</Collection>\n</VTKFile>\n";
    write_file(path_, text);
}

std::filesystem::path frame_file(std::string_view body, std::size_t number) {
    return fmt::format("frames/{}_{:06}.vtp", body, number);
}

}   // namespace patency
