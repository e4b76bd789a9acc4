"""The energies of make_truth.py, each with its gradient and Hessian, and their check by finite differences."""
import numpy as np


def epsilon():
    e = np.zeros((3, 3, 3))
    e[0, 1, 2] = e[1, 2, 0] = e[2, 0, 1] = 1
    e[0, 2, 1] = e[2, 1, 0] = e[1, 0, 2] = -1
    return e


def cofactor(F):
    """J F^-T and J."""
    E = epsilon()
    cof = 0.5 * np.einsum("ikm,jln,kl...,mn...->ij...", E, E, F, F, optimize=True)
    return cof, np.einsum("ij...,ij...->...", F, cof) / 3


class Cells:
    """The material with the pressure p of the cells, W(F) - p (J - 1): gradient and Hessian as felupe wants them.

    |dev(U - I)|^2 = tr C - (tr U)^2 / 3. The derivative of tr U by F is R, and with F = P s Q^T the part of dF that
    turns gives dR: (P^T dR Q)_ij = ((P^T dF Q)_ij - (P^T dF Q)_ji) / (s_i + s_j).
    """

    def __init__(self, mu, kappa):
        self.mu, self.kappa = mu, kappa
        self.x = [np.zeros((3, 3)), np.zeros(0)]

    @staticmethod
    def polar(F):
        P, s, Qt = np.linalg.svd(np.moveaxis(F, (0, 1), (-2, -1)))
        flip = np.where(np.linalg.det(P @ Qt) < 0, -1.0, 1.0)  # the rotation next to a reflection
        P[..., :, 2] *= flip[..., None]
        s[..., 2] *= flip
        return P, s, Qt

    def energy(self, F):
        _, s, _ = self.polar(F)
        tr_C, J = np.einsum("ij...,ij...->...", F, F), cofactor(F)[1]
        return self.mu * (tr_C - s.sum(-1) ** 2 / 3) + self.kappa / 2 * (J - 1) ** 2

    def gradient(self, x):
        F, p, state = x[0], x[1], x[-1]
        P, s, Qt = self.polar(F)
        R = np.moveaxis(P @ Qt, (-2, -1), (0, 1))
        cof, J = cofactor(F)
        stress = 2 * self.mu * (F - s.sum(-1) / 3 * R) + (self.kappa * (J - 1) - p[0]) * cof
        return [stress, -(J - 1)[None], state]

    def hessian(self, x):
        F, p = x[0], x[1]
        P, s, Qt = self.polar(F)
        R = np.moveaxis(P @ Qt, (-2, -1), (0, 1))
        cof, J = cofactor(F)
        I, E = np.eye(3), epsilon()
        A = np.zeros((3, 3, 3, 3) + J.shape)
        A += 2 * self.mu * np.einsum("ik,jl->ijkl", I, I)[..., None, None]
        A -= 2 * self.mu / 3 * np.einsum("ij...,kl...->ijkl...", R, R)
        for a in range(3):
            for b in range(a):
                # the turn about the third principal axis, dR = w (P_a Q_b - P_b Q_a), w = (...) : dF / (s_a + s_b)
                turn = (P[..., :, a, None] * Qt[..., None, b, :] - P[..., :, b, None] * Qt[..., None, a, :])
                turn = np.moveaxis(turn, (-2, -1), (0, 1))
                rate = s.sum(-1) / (s[..., a] + s[..., b])
                A -= 2 * self.mu / 3 * rate * np.einsum("ij...,kl...->ijkl...", turn, turn)
        A += self.kappa * np.einsum("ij...,kl...->ijkl...", cof, cof)
        A += (self.kappa * (J - 1) - p[0]) * np.einsum("ikm,jln,mn...->ijkl...", E, E, F, optimize=True)
        return [A, -cof, np.zeros_like(p)]


class NeoHookeanCells:
    """The same of mu/2 (tr C - 3 - 2 ln J) + lambda/2 (J - 1)^2."""

    def __init__(self, mu, lame):
        self.mu, self.lame = mu, lame
        self.x = [np.zeros((3, 3)), np.zeros(0)]

    def energy(self, F):
        J = cofactor(F)[1]
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.mu / 2 * (np.einsum("ij...,ij...->...", F, F) - 3 - 2 * np.log(J)) + self.lame / 2 * (J - 1) ** 2

    def gradient(self, x):
        F, p, state = x[0], x[1], x[-1]
        cof, J = cofactor(F)
        slope = np.where(J > 0, self.lame * (J - 1) - p[0] - self.mu / J, np.nan)  # by J
        return [self.mu * F + slope * cof, -(J - 1)[None], state]

    def hessian(self, x):
        F, p = x[0], x[1]
        cof, J = cofactor(F)
        I, E = np.eye(3), epsilon()
        A = np.zeros((3, 3, 3, 3) + J.shape)
        A += self.mu * np.einsum("ik,jl->ijkl", I, I)[..., None, None]
        A += (self.lame + self.mu / J**2) * np.einsum("ij...,kl...->ijkl...", cof, cof)
        A += (self.lame * (J - 1) - p[0] - self.mu / J) * np.einsum("ikm,jln,mn...->ijkl...", E, E, F, optimize=True)
        return [A, -cof, np.zeros_like(p)]


class Film:
    """Lines along the unit vectors t on a face: weight (l - r)^2 per area where l = |F t| > r; `scale` is the part of
    the load."""

    def __init__(self, tangent, weight, rest):
        self.t, self.weight, self.rest, self.scale = tangent, weight, rest, 0.0
        self.x = [np.zeros((3, 3)), np.zeros(0)]

    def parts(self, F):
        d = np.einsum("ij...,j...->i...", F, self.t)
        length = np.sqrt((d * d).sum(0))
        taut = length > self.rest
        slope = 2 * self.scale * self.weight * np.where(taut, length - self.rest, 0)
        return d / length, length, slope, 2 * self.scale * self.weight * taut

    def gradient(self, x):
        n, _, slope, _ = self.parts(x[0])
        return [np.einsum("i...,j...->ij...", slope * n, self.t), x[-1]]

    def hessian(self, x):
        n, length, slope, curve = self.parts(x[0])
        tt = np.einsum("j...,l...->jl...", self.t, self.t)
        across = slope / length
        M = np.einsum("i...,k...->ik...", (curve - across) * n, n) + across * np.eye(3)[..., None, None]
        return [np.einsum("ik...,jl...->ijkl...", M, tt)]


def check_energies():
    """Stress and tangent against central differences, at random deformations."""
    rng = np.random.default_rng(1)
    F = np.eye(3)[..., None, None] + 0.35 * rng.standard_normal((3, 3, 1, 20))
    F = F[..., np.linalg.det(np.moveaxis(F, (0, 1), (-2, -1)))[0] > 0.2]
    p, h = 0.3 * np.ones((1,) + F.shape[2:]), 1e-6
    film = Film(rng.standard_normal((3,) + F.shape[2:]), 0.7, 0.4)
    film.t /= np.linalg.norm(film.t, axis=0)
    film.scale = 1
    pull, B = film.gradient([F, None])[0], film.hessian([F])[0]
    worst = 0
    for i in range(3):
        for j in range(3):
            dF = np.zeros_like(F)
            dF[i, j] = h
            up, down = F + dF, F - dF
            lengths = [np.linalg.norm(np.einsum("ij...,j...->i...", f, film.t), axis=0) for f in (up, down)]
            L = [film.weight * np.maximum(0, length - film.rest) ** 2 for length in lengths]
            differences = [pull[i, j] - (L[0] - L[1]) / (2 * h),
                           B[:, :, i, j] - (film.gradient([up, 0])[0] - film.gradient([down, 0])[0]) / (2 * h)]
            for law in (Cells(0.37, 1.9), NeoHookeanCells(0.37, 1.9)):
                W = [law.energy(f) - p[0] * (cofactor(f)[1] - 1) for f in (up, down)]
                stress, A = law.gradient([F, p, None])[0], law.hessian([F, p])[0]
                differences += [
                    stress[i, j] - (W[0] - W[1]) / (2 * h),
                    A[:, :, i, j] - (law.gradient([up, p, 0])[0] - law.gradient([down, p, 0])[0]) / (2 * h)]
            worst = max(worst, *(np.abs(d).max() for d in differences))
    assert worst < 1e-7, worst
