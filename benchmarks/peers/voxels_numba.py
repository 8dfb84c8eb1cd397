"""Voxel count of 4PPa-2PaR's workspace, compiled by numba: the loops of voxel_loop.cpp."""

from math import cos, pi, sin, sqrt

from numba import njit


@njit(cache=True)
def _feasible_cells(a, b, l_u, l_d, d, L0, n_x, n_z, n_theta, alpha_min, beta_min, beta_max, h_min, sin_par_min,
                    cos_theta_min):
    y = L0 / 2
    x_min, x_max = l_d * sin(beta_min), l_d * sin(beta_max)
    z_max = -l_u * sin(alpha_min)
    feasible = 0
    for k in range(n_theta):
        theta = -pi / 2 + (k + 0.5) * pi / n_theta
        c = cos(theta)
        if c < cos_theta_min:
            continue
        half, shift = a / 2 * c, a / 2 * sin(theta)
        for i in range(n_x):
            x = (i + 0.5) * b / n_x
            x_1, x_2 = x - half, b - x - half
            if x_1 < x_min or x_1 > x_max or x_2 < x_min or x_2 > x_max:
                continue
            sigma_1, sigma_2 = sqrt(l_d * l_d - x_1 * x_1), sqrt(l_d * l_d - x_2 * x_2)
            if x_1 * sigma_2 + sigma_1 * x_2 < sin_par_min * l_d * l_d:
                continue
            for j in range(n_z):
                z = -(l_u + l_d + d) + (j + 0.5) * (l_u + l_d) / n_z
                z_1, z_2 = z + d + sigma_1, z + d + sigma_2
                if z_1 > z_max or z_1 < -l_u or z_2 > z_max or z_2 < -l_u:
                    continue
                h_1, h_2 = sqrt(l_u * l_u - z_1 * z_1), sqrt(l_u * l_u - z_2 * z_2)
                if h_1 < h_min or h_2 < h_min:
                    continue
                if y - shift - h_1 >= 0 and y - shift + h_1 <= L0 and y + shift - h_2 >= 0 and y + shift + h_2 <= L0:
                    feasible += 1
    return feasible


def counter(problem):
    """Returns a function that maps a design (a, b, l_u, l_d) to its number of feasible voxels."""
    p = problem
    fixed = (p.d, p.L0, *p.cells, p.alpha_min, p.beta_min, p.beta_max, p.h_min, p.sin_par_min, p.cos_theta_min)
    return lambda design: _feasible_cells(*design, *fixed)
