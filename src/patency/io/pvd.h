// SPDX-License-Identifier: Apache-2.0
// The time series of one body: a ParaView collection (.pvd) that lists frames with their times. Does
// not write or read the frames.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace patency {

struct PvdFrame {
    double time;        ///< [s]
    std::string file;   ///< relative to the collection's folder
};
/// The frames of a collection, in its order. Throws FileError for a file that cannot be read or is none.
std::vector<PvdFrame> read_pvd(const std::filesystem::path& path);

class PvdWriter {
public:
    /// A new, empty series. Throws FileError.
    explicit PvdWriter(const std::filesystem::path& path);
    /// Go on with the series of an interrupted run: keeps the frames up to last_time (s). A missing file
    /// begins anew; one that is not a collection is a FileError.
    static PvdWriter resumed(const std::filesystem::path& path, double last_time);

    /// Append a frame at time (s); the file is a path relative to the collection's folder. The collection
    /// on disk is replaced as a whole: readers never see half of it. Throws FileError.
    void add(double time, const std::filesystem::path& file);

    bool ends_at(double time) const { return !frames_.empty() && frames_.back().time == time; }
    std::size_t size() const { return frames_.size(); }   ///< frames so far: the number of the next one

private:
    PvdWriter(const std::filesystem::path& path, std::vector<PvdFrame> frames);
    void write() const;

    std::filesystem::path path_;
    std::vector<PvdFrame> frames_;
};

/// "frames/fluid_000012.vtp"
std::filesystem::path frame_file(std::string_view body, std::size_t number);

}   // namespace patency
