// SPDX-License-Identifier: Apache-2.0
// The folder OUT of a run: where each result goes, whose folder it is, and whether a run can go on there.
#pragma once

#include <filesystem>
#include <string_view>

namespace patency {

/// Holds OUT for this process: as long as it lives, no other process of the program writes there.
class OutputFolder {
public:
    /// Make OUT, with its parents, or open it again. Throws FileError for a folder that has other files
    /// than this program's in it (no file .patency), for one that another process is writing to, and when
    /// it cannot be written.
    explicit OutputFolder(const std::filesystem::path& root);
    OutputFolder(OutputFolder&& other) noexcept;
    OutputFolder& operator=(OutputFolder&&) = delete;
    ~OutputFolder();

    const std::filesystem::path& root() const { return root_; }
    /// OUT/NAME: "summary.json", "log.txt", "fluid.pvd".
    std::filesystem::path file(std::string_view name) const { return root_ / name; }
    /// OUT/checkpoint/STAGE.h5
    std::filesystem::path checkpoint(std::string_view stage) const;
    /// Whether any stage, or this one, left a checkpoint.
    bool has_checkpoint() const;
    bool has_checkpoint(std::string_view stage) const;

    /// Remove what earlier runs left (`--fresh`): the results named in the user guide and nothing else.
    void clear() const;

private:
    std::filesystem::path root_;
    int lock_ = -1;   // descriptor of the marker; the kernel frees the lock even after kill -9
};

/// Whether the folder is one that OutputFolder made.
bool is_output_folder(const std::filesystem::path& root);

}   // namespace patency
