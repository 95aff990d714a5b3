function [x, value] = tune_tmd(study, program)
  % TUNE_TMD  Tunes the TMD of a study with fminsearch over the pipe, from k2 = 1900 N/m and c2 = 150 N s/m.
  %
  % fminsearch knows no bounds: a negative number has no value, and NaN is never the smallest.
  [x, value] = fminsearch(@(x) retune_values(study, x(:).', program), [1900 150], optimset('TolX', 1e-3, 'TolFun', 1e-6));
  fprintf('%.6f J at k2 = %.3f N/m, c2 = %.3f N s/m\n', value, x(1), x(2));
end
