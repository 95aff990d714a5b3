% GNU Octave's ode23s and ode45 on the scenes of scenes.json: as a user calls them, the force stepped over (ode23s has no
% better), and ode45 also with contacts located as terminal events. Writes octave.csv beside this file.
%
%   octave-cli --no-gui --quiet tests/reference/external/octave_methods.m
1;

function dy = f (t, y, s, phase)
  global evaluations
  evaluations += 1;
  z1 = y(1) - y(3);
  z2 = -z1 - s.D - s.C;
  push = 0;
  if (phase != 0 && phase != 2 && z1 > 0)
    push = s.K1 * z1 ^ 1.5;
  elseif (phase != 0 && phase != 1 && z2 > 0)
    push = -s.K3 * z2 ^ 1.5;
  end
  damper = push - s.c2 * (y(4) - y(2)) - s.k2 * (y(3) - y(1) - s.D);
  force = s.P * cos (s.omega * t);
  dy = [y(2); (force - s.c1 * y(2) - s.k1 * y(1) - damper) / s.m1; y(4); damper / s.m2];
end

function [value, terminal, direction] = wall (t, y, s, phase)
  r = y(3) - y(1);
  far = r - s.D - s.C;
  if (phase == 0)
    value = [r; -far];
  elseif (phase == 1)
    value = [-r; 1];
  else
    value = [far; 1];
  end
  terminal = [1; 1];
  direction = [-1; -1];
end

% The largest E1 of a motion known at times ts: between them x1 is the quintic that meets position, velocity and acceleration.
function best = largest (ts, ys, s, phase)
  energy = @(x, v) 0.5 * (s.m1 * v .^ 2 + s.k1 * x .^ 2);
  at = energy (ys(:, 1), ys(:, 2));
  best = max (at);
  u = linspace (0, 1, 201)';
  for i = find (max (at(1:end-1), at(2:end)) > 0.8 * best)'
    h = ts(i+1) - ts(i);
    a = f (ts(i), ys(i, :)', s, phase);
    b = f (ts(i+1), ys(i+1, :)', s, phase);
    c = [ys(i, 1); h * ys(i, 2); h^2 / 2 * a(2)];
    rest = [ys(i+1, 1) - sum(c); h * ys(i+1, 2) - c(2) - 2 * c(3); h^2 * b(2) - 2 * c(3)];
    p = [flipud([1, 1, 1; 3, 4, 5; 6, 12, 20] \ rest); flipud(c)]';
    best = max (best, max (energy (polyval (p, u), polyval (polyder (p), u) / h)));
  end
end

function v = ifelse_ (condition, yes, no)
  v = no;
  if (condition)
    v = yes;
  end
end

warning ("off", "all"); % each located event makes one
global evaluations
here = fileparts (mfilename ("fullpath"));
scenes = jsondecode (fileread (fullfile (here, "scenes.json")));
out = fopen (fullfile (here, "octave.csv"), "w");
fprintf (out, "program,method,scene,rtol,seconds,evaluations,E1max,x1,v1,x2,v2,impacts,failure\n");
methods = {"ode45 located", "ode45", "ode23s"};
for m = 1:numel (methods)
  exponents = {3:2:9, 3:2:9, 3:5}{m};
  for k = 1:numel (scenes)
    s = scenes(k);
    if (iscell (scenes))
      s = scenes{k};
    end
    for exponent = exponents
      rtol = 10 ^ -exponent;
      options = odeset ("RelTol", rtol, "AbsTol", rtol * 1e-3, "Refine", 1);
      failure = "";
      impacts = NaN; e1 = NaN; last = nan (1, 4); evaluations = 0; took = NaN;
      begun = tic ();
      try
        if (m == 1)
          t = 0; y = [0; 0; s.D; 0]; phase = 0; impacts = 0; events = 0; pieces = {};
          while (t < s.T && events < 2000)
            with = odeset (options, "Events", @(t, y) wall (t, y, s, phase));
            [ts, ys, te, ye, ie] = ode45 (@(t, y) f (t, y, s, phase), [t, s.T], y, with);
            t = ts(end); y = ys(end, :)';
            pieces{end + 1} = {ts, ys, phase};
            if (isempty (ie) || t >= s.T)
              break;
            end
            which = ie(end);
            nudge = 1e-15;
            events += 1;
            if (phase == 0)
              impacts += 1;
              y(3) += ifelse_ (which == 1, -nudge, nudge);
              phase = which;
            else
              y(3) += ifelse_ (phase == 1, nudge, -nudge);
              phase = 0;
            end
          end
          [took, used] = deal (toc (begun), evaluations);
          last = y';
          e1 = max (cellfun (@(p) largest (p{1}, p{2}, s, p{3}), pieces));
        else
          [ts, ys] = feval (methods{m}, @(t, y) f (t, y, s, -1), [0, s.T], [0; 0; s.D; 0], options);
          [took, used] = deal (toc (begun), evaluations);
          e1 = largest (ts, ys, s, -1);
          r = ys(:, 3) - ys(:, 1);
          impacts = sum (diff (r < 0) > 0) + sum (diff (r > s.D + s.C) > 0);
          last = ys(end, :);
        end
      catch problem
        failure = strrep (strrep (problem.message, ",", ";"), "\n", " ");
      end
      if (isnan (took))
        [took, used] = deal (toc (begun), evaluations);
      end
      fprintf (out, "GNU Octave %s,%s,%s,%g,%.4g,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%d,%s\n", version (), methods{m}, ...
               s.scene, rtol, took, used, e1, last, impacts, failure);
      fflush (out);
      if (took > 25)
        break;
      end
    end
  end
end
fclose (out);
