// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/order.h"

#include "patency/base/parallel.h"
#include "patency/schemes/watch.h"

namespace patency {

namespace {

template <class Particles>
void sort(Particles& particles, Cells& cells, const Frame& frame, double spacing) {
    particles.take(cells.find_order(frame, spacing, {particles.position.data(), particles.size()}));
    cells.index(frame, spacing, {particles.position.data(), particles.size()});
}

}   // namespace

void sort_blood(FluidParticles& fluid, Cells& cells, const Frame& frame, double spacing) {
    if (frame.any_periodic())
        for_each_index(fluid.size(), [&](std::size_t i) { fluid.position[i] = frame.wrapped(fluid.position[i]); });
    check_inside(fluid, frame);
    sort(fluid, cells, frame, spacing);
}

void sort_wall(WallParticles& wall, Cells& cells, const Frame& frame, double spacing) {
    sort(wall, cells, frame, spacing);
}

void number_wall_rows(const Neighbours& wall_rows, std::size_t particles, std::vector<std::uint32_t>& wall_of) {
    wall_of.assign(particles, no_wall);
    for_each_index(wall_rows.block_count(), [&](std::size_t b) {
        const auto& block = wall_rows.block(b);
        for (std::uint32_t m = 0; m < block.member_count; ++m) wall_of[block.members[m]] = block.first_member + m;
    });
}

}   // namespace patency
