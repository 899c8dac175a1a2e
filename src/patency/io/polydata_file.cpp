// SPDX-License-Identifier: Apache-2.0
#include "patency/io/polydata_file.h"

#include "patency/io/atomic_file.h"
#include "patency/io/surface_formats.h"

namespace patency {

PolyData read_polydata(const std::filesystem::path& path) {
    const std::string bytes = read_file(path);
    PolyData data = parse_vtp_polydata({path, bytes});
    for (Vec3& x : data.points) x = 1e-3 * x;   // files are in mm
    return data;
}

}   // namespace patency
