// SPDX-License-Identifier: Apache-2.0
// The linearised flow between cells as a matrix of 4 x 4 blocks, and coarser ones made of it: a multigrid on agglomerated
// cells. Single precision: it corrects a residual that is known in double. Knows no physics.     THEORY.md (18.12), (18.13)
#pragma once

#include <cstdint>
#include <vector>

#include "patency/cells/cell_mesh.h"

namespace patency {

/// Pressure and velocity of a cell: p, u, v, w.
typedef float CellVector __attribute__((vector_size(16)));
using CellVectors = std::vector<CellVector>;

/// Sum of all products, in double and in fixed blocks: the same bits for any number of threads.
double product(const CellVectors& a, const CellVectors& b);

/// Row i:  pressure  p_diagonal p_i + divergence . u_i + sum_j (-c_ij p_j + a_ij . u_j)
///         velocity  m_diagonal u_i + gradient p_i     + sum_j (m_ij u_j + a_ij p_j)
struct CellMatrixRow {
    float p_diagonal = 0, m_diagonal = 0;
    CellVector gradient{}, divergence{};   // their first number is zero
};

struct CellLevel {
    std::vector<std::uint32_t> start, column;   // rows; ascending
    std::vector<CellVector> coupling;           // (-c, a_x, a_y, a_z)
    std::vector<float> transport;               // m
    std::vector<CellMatrixRow> diagonal;

    std::vector<std::uint32_t> parent;               // the coarser cell
    std::vector<std::uint32_t> child_start, child;   // of the finer level, by this level's cells
    std::vector<std::uint32_t> entry_parent;         // the coarser entry; `inside` if both cells have one parent

    // Runs of block_rows rows are smoothed in turn: first all of colour 0, on all threads, then of colour 1, ..
    // No two neighbouring runs have one colour, so the order does not depend on the number of threads.
    std::vector<std::vector<std::uint32_t>> colours;
    CellVectors x, b, r;
    CellVectors first, answer;   // of a coarser level's first cycle: what it found, and the matrix times that

    static constexpr std::uint32_t inside = 0xffffffff;
    std::size_t size() const { return diagonal.size(); }
};

class CellMatrix {
public:
    /// Cells that share the largest conductances are joined, in three rounds of pairs per level, until few are left.
    explicit CellMatrix(const CellMesh& mesh);

    /// The rows of the cells: entries as mesh.row. Fill them, then call make_coarse.
    CellLevel& finest() { return levels_.front(); }
    void make_coarse();

    void multiply(const CellVectors& x, CellVectors& y) const;
    /// One cycle from zero: x is about the inverse times b.
    void precondition(const CellVectors& b, CellVectors& x);

    std::size_t level_count() const { return levels_.size(); }

private:
    void cycle(std::size_t level);
    void solve_coarse(std::size_t level);
    std::vector<CellLevel> levels_;
};

}   // namespace patency
