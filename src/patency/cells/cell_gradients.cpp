// SPDX-License-Identifier: Apache-2.0
#include "patency/cells/cell_gradients.h"

#include <algorithm>

#include "patency/base/parallel.h"

namespace patency {

namespace {

bool has_value(const CellPatch& patch, std::span<const char> is_known) {
    return patch.opening >= 0 && is_known[std::size_t(patch.opening)];
}

/// Inverse of the moments sum w d (x) d of a cell.
Mat3 inverse_moments(const CellMesh& mesh, std::size_t i, std::span<const char> is_known) {
    Mat3 moments{};
    for (const CellNeighbour& n : mesh.neighbours(i)) {
        const Vec3 d = mesh.point[n.cell] - mesh.point[i];
        moments += (mesh.faces[n.face].conductance / norm(d)) * outer(d, d);
    }
    for (const CellPatch& patch : mesh.patches_of(i)) {
        const Vec3 d = patch.centroid - mesh.point[i];
        if (has_value(patch, is_known)) moments += (norm(patch.area) / dot(d, d)) * outer(d, d);
        // The image behind a plane of symmetry has the cell's own value.
        if (patch.opening == CellPatch::symmetry) moments += norm(patch.area) * outer(patch.normal, patch.normal);
    }
    moments += 1e-12 * trace(moments) * identity<double>();
    return inverse(moments);
}

/// The least-squares weights of one cell.
void put_weights(const CellMesh& mesh, std::size_t i, std::span<const char> is_known, CellGradients& gradients) {
    const Mat3 inverse = inverse_moments(mesh, i, is_known);
    for (std::size_t k = mesh.row_start[i]; k < mesh.row_start[i + 1]; ++k) {
        const Vec3 d = mesh.point[mesh.row[k].cell] - mesh.point[i];
        gradients.row[k] = inverse * ((mesh.faces[mesh.row[k].face].conductance / norm(d)) * d);
    }
    for (std::size_t k = mesh.patch_start[i]; k < mesh.patch_start[i + 1]; ++k) {
        const CellPatch& patch = mesh.patches[k];
        if (!has_value(patch, is_known)) continue;
        const Vec3 d = patch.centroid - mesh.point[i];
        gradients.patch[k] = inverse * ((norm(patch.area) / dot(d, d)) * d);
    }
}

CellGradients empty_gradients(const CellMesh& mesh) {
    return {std::vector<Vec3>(mesh.row.size()), std::vector<Vec3>(mesh.patches.size()), std::vector<Vec3>(mesh.size())};
}

}   // namespace

CellGradients make_gradients(const CellMesh& mesh, std::span<const char> is_known) {
    CellGradients gradients = empty_gradients(mesh);
    for_each_index(mesh.size(), [&](std::size_t i) { put_weights(mesh, i, is_known, gradients); });
    return gradients;
}

CellGradients make_gradients_at_rest_on_walls(const CellMesh& mesh, std::span<const char> is_known) {
    CellGradients gradients = empty_gradients(mesh);
    const std::vector<char> nowhere(is_known.size(), 0);
    for_each_index(mesh.size(), [&](std::size_t i) {
        const auto patches = mesh.patches_of(i);
        if (std::none_of(patches.begin(), patches.end(),
                         [](const CellPatch& p) { return p.opening == CellPatch::wall; })) {
            put_weights(mesh, i, is_known, gradients);
            return;
        }
        // With f = s v: grad f = s grad v - v n, and v_j - v_i = f_j / s_j - f_i / s_i.
        put_weights(mesh, i, nowhere, gradients);
        const double s = mesh.wall_distance[i];
        const Vec3& normal = mesh.wall_normal[i];
        Vec3 self = -1 / s * normal;
        for (std::size_t k = mesh.row_start[i]; k < mesh.row_start[i + 1]; ++k) {
            const std::uint32_t j = mesh.row[k].cell;
            const double known = mesh.wall_distance[j];
            const double s_j = known < CellMesh::far ? known : s - dot(normal, mesh.point[j] - mesh.point[i]);
            const Vec3 weight = gradients.row[k];
            gradients.row[k] = (s / s_j) * weight;
            self += (s / s_j - 1) * weight;
        }
        gradients.self[i] = self;
    });
    return gradients;
}

}   // namespace patency
