% GNU Octave's ode23s and ode45 on the scenes of scenes.json: as a user calls them, the force stepped over (ode23s has no
% better), and ode45 also with contacts located as terminal events. Writes octave.csv beside this file.
%
%   octave-cli --no-gui --quiet tests/reference/external/octave_methods.m
1;

function dy = f (t, y, s, phase)
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

function v = ifelse_ (condition, yes, no)
  v = no;
  if (condition)
    v = yes;
  end
end

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
      impacts = NaN; e1 = NaN; last = nan (1, 4); steps = 0; evaluations = NaN;
      begun = tic ();
      try
        if (m == 1)
          t = 0; y = [0; 0; s.D; 0]; phase = 0; impacts = 0; e1 = 0; events = 0;
          while (t < s.T && events < 2000)
            with = odeset (options, "Events", @(t, y) wall (t, y, s, phase));
            [ts, ys, te, ye, ie] = ode45 (@(t, y) f (t, y, s, phase), [t, s.T], y, with);
            e1 = max ([e1; 0.5 * (s.m1 * ys(:, 2) .^ 2 + s.k1 * ys(:, 1) .^ 2)]);
            t = ts(end); y = ys(end, :)';
            steps += numel (ts) - 1;
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
          evaluations = 6 * steps;
          last = y';
        else
          [ts, ys] = feval (methods{m}, @(t, y) f (t, y, s, -1), [0, s.T], [0; 0; s.D; 0], options);
          e1 = max (0.5 * (s.m1 * ys(:, 2) .^ 2 + s.k1 * ys(:, 1) .^ 2));
          r = ys(:, 3) - ys(:, 1);
          impacts = sum (diff (r < 0) > 0) + sum (diff (r > s.D + s.C) > 0);
          last = ys(end, :);
          evaluations = ifelse_ (m == 2, 6, 7) * (numel (ts) - 1); % ode23s: 3, and 4 for its finite-difference Jacobian
        end
      catch problem
        failure = strrep (strrep (problem.message, ",", ";"), "\n", " ");
      end
      took = toc (begun);
      fprintf (out, "GNU Octave %s,%s,%s,%g,%.4g,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%d,%s\n", version (), methods{m}, ...
               s.scene, rtol, took, evaluations, e1, last, impacts, failure);
      fflush (out);
      if (took > 25)
        break;
      end
    end
  end
end
fclose (out);
