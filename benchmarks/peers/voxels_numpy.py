"""Voxel count of 4PPa-2PaR's workspace, vectorised with numpy: first tests all columns (theta, x), then the voxels of
the remaining columns. Formulas as in voxel_loop.cpp."""

import numpy as np


def counter(problem):
    """Returns a function that maps a design (a, b, l_u, l_d) to its number of feasible voxels."""
    p = problem
    n_x, n_z, n_theta = p.cells
    x_centres, z_centres = (np.arange(n_x) + 0.5) / n_x, (np.arange(n_z) + 0.5) / n_z
    theta = -np.pi / 2 + (np.arange(n_theta) + 0.5) * np.pi / n_theta
    theta = theta[np.cos(theta) >= p.cos_theta_min]
    cos_theta, sin_theta = np.cos(theta)[:, None], np.sin(theta)[:, None]

    def feasible_cells(design):
        a, b, l_u, l_d = design
        y = p.L0 / 2
        x, half = b * x_centres, a / 2 * cos_theta
        x_1, x_2 = x - half, b - x - half
        x_min, x_max = l_d * np.sin(p.beta_min), l_d * np.sin(p.beta_max)
        within = (x_1 >= x_min) & (x_1 <= x_max) & (x_2 >= x_min) & (x_2 <= x_max)
        x_1, x_2 = x_1[within], x_2[within]
        shift = np.broadcast_to(a / 2 * sin_theta, within.shape)[within]
        sigma_1, sigma_2 = np.sqrt(l_d * l_d - x_1 * x_1), np.sqrt(l_d * l_d - x_2 * x_2)
        apart = x_1 * sigma_2 + sigma_1 * x_2 >= p.sin_par_min * l_d * l_d
        sigma_1, sigma_2, shift = sigma_1[apart, None], sigma_2[apart, None], shift[apart, None]
        depth = -(l_u + l_d) + (l_u + l_d) * z_centres  # z + d
        z_1, z_2 = depth + sigma_1, depth + sigma_2
        z_max = -l_u * np.sin(p.alpha_min)
        reached = (z_1 <= z_max) & (z_1 >= -l_u) & (z_2 <= z_max) & (z_2 >= -l_u)
        z_1, z_2, shift = z_1[reached], z_2[reached], np.broadcast_to(shift, reached.shape)[reached]
        h_1, h_2 = np.sqrt(l_u * l_u - z_1 * z_1), np.sqrt(l_u * l_u - z_2 * z_2)
        return np.count_nonzero((h_1 >= p.h_min) & (h_2 >= p.h_min) & (y - shift - h_1 >= 0) & (y - shift + h_1 <= p.L0)
                                & (y + shift - h_2 >= 0) & (y + shift + h_2 <= p.L0))

    return feasible_cells
