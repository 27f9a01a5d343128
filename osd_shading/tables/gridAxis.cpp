// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/gridAxis.h"

#include <algorithm>

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

AxisRows refineAxis(GridAxis const& axis) {
    GridAxis const next = axis.Refined();
    AxisRows rows;
    for (int i = next.First(); i <= next.Last(); ++i) {
        int const at = (i + 2) / 2 - 1 - axis.First();  // rounds down
        if (i % 2 != 0) {
            rows.rows.push_back({at, 2, {0.5, 0.5}});
        } else if (axis.IsOnSharpEnd(i / 2)) {
            rows.rows.push_back({at, 1, {1}});
        } else {
            rows.rows.push_back({at - 1, 3, {0.125, 0.75, 0.125}});
        }
    }
    return rows;
}

/// Beyond a sharp end a spline has the mirror image of the point inside: what the two weigh together is never
/// negative.
AxisRows limitAxis(GridAxis const& axis, int k) {
    int const perCell = 1 << k;
    AxisRows rows;
    for (int p = 0; p <= axis.numCells * perCell; ++p) {
        int const cell = std::min(p / perCell, axis.numCells - 1);
        double const t = static_cast<double>(p - cell * perCell) / perCell, s = 1 - t;
        double const t3 = t * t * t, s3 = s * s * s;
        // Of the points at cell - 1 .. cell + 2.
        double w[4] = {s3 / 6, (4 - 6 * t * t + 3 * t3) / 6, (4 - 6 * s * s + 3 * s3) / 6, t3 / 6};
        bool const foldsStart = axis.isSharpAtStart && cell == 0;
        bool const foldsEnd = axis.isSharpAtEnd && cell == axis.numCells - 1;
        if (foldsStart && foldsEnd) {
            w[0] = w[3] = 0;
            w[1] = s;
            w[2] = t;
        } else if (foldsStart) {
            w[0] = 0;
            w[1] = s + t3 / 6;
            w[2] = t - t3 / 3;
        } else if (foldsEnd) {
            w[3] = 0;
            w[2] = t + s3 / 6;
            w[1] = s - s3 / 3;
        }
        // Those that weigh something follow each other.
        AxisRows::Row row{0, 0, {}};
        for (int i = 0; i < 4; ++i) {
            if (!(w[i] > 0)) continue;
            if (row.size == 0) row.first = cell - 1 + i - axis.First();
            row.weights[row.size++] = w[i];
        }
        rows.rows.push_back(row);
    }
    return rows;
}

}  // namespace

AxisRows const& AxisRules::Refinement(GridAxis const& axis) {
    auto const [known, isNew] = _known.try_emplace({axis.numCells, axis.isSharpAtStart, axis.isSharpAtEnd, -1});
    if (isNew) known->second = refineAxis(axis);
    return known->second;
}

AxisRows const& AxisRules::Limits(GridAxis const& axis, int k) {
    auto const [known, isNew] = _known.try_emplace({axis.numCells, axis.isSharpAtStart, axis.isSharpAtEnd, k});
    if (isNew) known->second = limitAxis(axis, k);
    return known->second;
}

std::vector<double> ApplyAxes(std::vector<double> const& grid, int numColumns, AxisRows const& u,
                              AxisRows const& v) {
    std::size_t const numRows = grid.size() / index(numColumns);
    std::vector<double> across(numRows * u.Size());
    for (std::size_t row = 0; row < numRows; ++row) {
        double const* const from = grid.data() + row * index(numColumns);
        for (std::size_t i = 0; i < u.Size(); ++i) {
            AxisRows::Row const& terms = u.rows[i];
            double sum = 0;
            for (int t = 0; t < terms.size; ++t) sum += terms.weights[t] * from[terms.first + t];
            across[row * u.Size() + i] = sum;
        }
    }
    std::vector<double> result(v.Size() * u.Size(), 0.0);
    for (std::size_t i = 0; i < v.Size(); ++i) {
        double* const to = result.data() + i * u.Size();
        AxisRows::Row const& terms = v.rows[i];
        for (int t = 0; t < terms.size; ++t) {
            double const* const from = across.data() + index(terms.first + t) * u.Size();
            for (std::size_t j = 0; j < u.Size(); ++j) to[j] += terms.weights[t] * from[j];
        }
    }
    return result;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
