// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/tether.h"

#include <vector>

namespace patency {

namespace {

class Tether final : public Contact {
public:
    Tether(SolidSurface& surface, std::uint16_t face, double stiffness) : surface_(surface) {
        std::vector<double> area(surface.size(), 0);
        const SurfaceElements& mesh = surface.mesh();
        for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
            if (mesh.face[e] != face) continue;
            const auto& [a, b, c] = mesh.elements[e];
            const double third =
                norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a])) / 6;
            for (const std::uint32_t v : mesh.elements[e]) area[v] += third;
        }
        for (std::uint32_t v = 0; v < area.size(); ++v)
            if (area[v] > 0) springs_.push_back({v, stiffness * area[v]});
    }

    void add_forces(double, double) override {
        for (const auto& [v, k] : springs_) surface_.force[v] -= k * stretch(v);
    }
    ContactReport report() const override {
        ContactReport report;
        for (const auto& [v, k] : springs_)
            report.energy += 0.5 * k * dot(stretch(v), stretch(v)), report.force -= k * stretch(v);
        return report;
    }
    std::vector<Push> pushes() const override { return {}; }
    std::vector<double> state() const override { return {}; }   // all of it is in the places
    void restore(std::span<const double>) override {}

private:
    struct Spring {
        std::uint32_t vertex;
        double stiffness;   // N/m
    };
    Vec3 stretch(std::uint32_t v) const { return surface_.position[v] - surface_.mesh().vertices[v]; }

    SolidSurface& surface_;
    std::vector<Spring> springs_;
};

}   // namespace

std::unique_ptr<Contact> make_tether(SolidSurface& surface, std::uint16_t face, double stiffness) {
    return std::make_unique<Tether>(surface, face, stiffness);
}

}   // namespace patency
