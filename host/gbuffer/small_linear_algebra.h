// Private to host/gbuffer: dense linear algebra for a dozen unknowns.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace clshade {

template <std::size_t N>
using SmallVector = std::array<double, N>;
template <std::size_t N>
using SmallMatrix = std::array<std::array<double, N>, N>;

/// Eigenvalues and eigenvectors (columns of `vectors`) of a symmetric matrix.
template <std::size_t N>
struct Eigensystem {
    SmallVector<N> values{};
    SmallMatrix<N> vectors{};

    /// Index of the smallest eigenvalue.
    [[nodiscard]] std::size_t smallest() const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < N; ++i) {
            best = values[i] < values[best] ? i : best;
        }
        return best;
    }
    [[nodiscard]] SmallVector<N> vector(std::size_t index) const {
        SmallVector<N> v{};
        for (std::size_t i = 0; i < N; ++i) {
            v[i] = vectors[i][index];
        }
        return v;
    }
};

/// Cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, section 8.5): slow but accurate to the last bits,
/// also for the smallest eigenvalue.
template <std::size_t N>
[[nodiscard]] Eigensystem<N> symmetric_eigensystem(SmallMatrix<N> a) {
    Eigensystem<N> system;
    for (std::size_t i = 0; i < N; ++i) {
        system.vectors[i][i] = 1.0;
    }
    for (int sweep = 0; sweep < 30; ++sweep) {
        double off = 0.0;
        double diagonal = 0.0;
        for (std::size_t i = 0; i < N; ++i) {
            diagonal += a[i][i] * a[i][i];
            for (std::size_t j = i + 1; j < N; ++j) {
                off += a[i][j] * a[i][j];
            }
        }
        if (!(off > 1e-32 * diagonal)) {
            break;
        }
        for (std::size_t p = 0; p < N; ++p) {
            for (std::size_t q = p + 1; q < N; ++q) {
                if (a[p][q] == 0.0) {
                    continue;
                }
                const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
                const double c = 1.0 / std::sqrt(t * t + 1.0);
                const double s = t * c;
                for (std::size_t k = 0; k < N; ++k) {
                    const double kp = a[k][p];
                    const double kq = a[k][q];
                    a[k][p] = c * kp - s * kq;
                    a[k][q] = s * kp + c * kq;
                }
                for (std::size_t k = 0; k < N; ++k) {
                    const double pk = a[p][k];
                    const double qk = a[q][k];
                    a[p][k] = c * pk - s * qk;
                    a[q][k] = s * pk + c * qk;
                    const double vp = system.vectors[k][p];
                    const double vq = system.vectors[k][q];
                    system.vectors[k][p] = c * vp - s * vq;
                    system.vectors[k][q] = s * vp + c * vq;
                }
            }
        }
    }
    for (std::size_t i = 0; i < N; ++i) {
        system.values[i] = a[i][i];
    }
    return system;
}

/// Solves A x = b for a symmetric positive definite A of which the leading `n` rows count (Cholesky); empty if A is
/// not positive definite.
template <std::size_t N>
[[nodiscard]] std::optional<SmallVector<N>> solve_positive(SmallMatrix<N> a, SmallVector<N> b, std::size_t n) {
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
            a[j][j] -= a[j][k] * a[j][k];
        }
        if (!(a[j][j] > 0.0) || !std::isfinite(a[j][j])) {
            return std::nullopt;
        }
        a[j][j] = std::sqrt(a[j][j]);
        for (std::size_t i = j + 1; i < n; ++i) {
            for (std::size_t k = 0; k < j; ++k) {
                a[i][j] -= a[i][k] * a[j][k];
            }
            a[i][j] /= a[j][j];
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            b[i] -= a[i][k] * b[k];
        }
        b[i] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) {
            b[i] -= a[k][i] * b[k];
        }
        b[i] /= a[i][i];
    }
    return b;
}

} // namespace clshade
