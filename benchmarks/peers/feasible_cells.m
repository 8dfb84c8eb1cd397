% Counts the feasible voxels of 4PPa-2PaR's workspace: first tests all columns (x, theta), then the voxels of the
% remaining columns. Formulas as in voxel_loop.cpp.
function count = feasible_cells(p, design)
  a = design(1); b = design(2); l_u = design(3); l_d = design(4);
  y = p.L0 / 2;
  theta = -pi / 2 + ((1:p.cells(3)) - 0.5) * pi / p.cells(3);
  theta = theta(cos(theta) >= p.cos_theta_min);
  x = ((1:p.cells(1))' - 0.5) * b / p.cells(1);
  x_1 = x - a / 2 * cos(theta);
  x_2 = b - x - a / 2 * cos(theta);
  shift = repmat(a / 2 * sin(theta), rows(x), 1);
  x_min = l_d * sin(p.beta_min);
  x_max = l_d * sin(p.beta_max);
  within = x_1 >= x_min & x_1 <= x_max & x_2 >= x_min & x_2 <= x_max;
  x_1 = x_1(within)'; x_2 = x_2(within)'; shift = shift(within)';
  sigma_1 = sqrt(l_d^2 - x_1.^2);
  sigma_2 = sqrt(l_d^2 - x_2.^2);
  apart = x_1 .* sigma_2 + sigma_1 .* x_2 >= p.sin_par_min * l_d^2;
  sigma_1 = sigma_1(apart); sigma_2 = sigma_2(apart); shift = shift(apart);

  depth = -(l_u + l_d) + ((1:p.cells(2))' - 0.5) * (l_u + l_d) / p.cells(2);  % z + d
  z_1 = depth + sigma_1;
  z_2 = depth + sigma_2;
  z_max = -l_u * sin(p.alpha_min);
  h_1 = sqrt(max(l_u^2 - z_1.^2, 0));
  h_2 = sqrt(max(l_u^2 - z_2.^2, 0));
  h_1_max = min(y - shift, p.L0 - y + shift);  % larger values: a slider leaves its rail
  h_2_max = min(y + shift, p.L0 - y - shift);
  count = nnz(z_1 >= -l_u & z_1 <= z_max & z_2 >= -l_u & z_2 <= z_max ...
              & h_1 >= p.h_min & h_2 >= p.h_min & h_1 <= h_1_max & h_2 <= h_2_max);
end
