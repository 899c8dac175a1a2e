// SPDX-License-Identifier: Apache-2.0
// The linearised flow between cells as a matrix of 4 x 4 blocks, and coarser ones made of it: a multigrid on agglomerated
// cells. Single precision: it corrects a residual that is known in double. Knows no physics.     THEORY.md (18.12), (18.13)
#pragma once

#include <cstdint>
#include <span>
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
    float per_momentum = 0,
          per_pressure = 0;                // what the row is solved by for its own four unknowns: make_coarse sets them
    CellVector gradient{}, divergence{};   // their first number is zero
};

/// What a neighbour adds to a row.
struct CellMatrixEntry {
    float coupling[4];   ///< -c, a_x, a_y, a_z
    float transport;     ///< m
    std::uint32_t column;
};

/// A part of every row, by rising columns. One stream of memory: of many cells nothing else is waited for.
struct CellTriangle {
    std::vector<std::uint32_t> start;   // rows, and one more
    std::vector<CellMatrixEntry> entry;
    std::vector<std::uint16_t>
        parent;   // the coarser entry, as it is counted in its row; `inside` if both cells have one parent

    static constexpr std::uint16_t inside = 0xffff;
    std::span<const CellMatrixEntry> row(std::size_t i) const {
        return {entry.data() + start[i], entry.data() + start[i + 1]};
    }
};

struct CellLevel {
    CellTriangle earlier, later;   // neighbours that a sweep there comes to before the row, and after it
    std::vector<CellMatrixRow> diagonal;

    std::vector<std::uint32_t> parent;               // the coarser cell
    std::vector<std::uint32_t> child_start, child;   // of the finer level, by this level's cells

    // Runs of run_length rows are smoothed in turn: first all of colour 0, on all threads, then of colour 1, ..
    // No two neighbouring runs have one colour, so the order does not depend on the number of threads.
    static constexpr std::size_t run_length = 512;
    std::vector<std::uint32_t> colour;                 // per run
    std::vector<std::vector<std::uint32_t>> colours;   // runs of each
    CellVectors x, b, r;
    CellVectors change;          // of x in the last sweep back
    CellVectors first, answer;   // of a coarser level's first cycle: what it found, and the matrix times that

    std::size_t size() const { return diagonal.size(); }
    /// Whether a sweep there comes to row j before row i.
    bool is_earlier(std::size_t j, std::size_t i) const {
        const std::size_t of_j = j / run_length, of_i = i / run_length;
        return of_j == of_i ? j < i : colour[of_j] < colour[of_i];
    }
};

/// The entries of a row in the order of its columns.
class CellRow {
public:
    CellRow(CellLevel& level, std::size_t i)
        : level_(level), row_(i), earlier_(level.earlier.start[i]), later_(level.later.start[i]) {}
    CellMatrixEntry& next(std::size_t column) {
        return level_.is_earlier(column, row_) ? level_.earlier.entry[earlier_++] : level_.later.entry[later_++];
    }

private:
    CellLevel& level_;
    std::size_t row_;
    std::uint32_t earlier_, later_;
};

class CellMatrix {
public:
    /// Cells that share the largest conductances are joined, in three rounds of pairs per level, until few are left.
    explicit CellMatrix(const CellMesh& mesh);

    /// The rows of the cells: a CellRow goes through the neighbours as mesh.row does. Fill all, then call make_coarse.
    CellLevel& finest() { return levels_.front(); }
    void make_coarse();

    /// Straight from the definition: what tests hold the product of `precondition` against.
    void multiply(const CellVectors& x, CellVectors& y) const;
    /// One cycle from zero: x is about the inverse times b, and `product` is the matrix times x, which costs half of multiply here.
    void precondition(const CellVectors& b, CellVectors& x, CellVectors& product);

    std::size_t level_count() const { return levels_.size(); }

private:
    void cycle(std::size_t level);
    void solve_coarse(std::size_t level);
    std::vector<CellLevel> levels_;
};

}   // namespace patency
