function values = retune_values(study, X, program)
  % RETUNE_VALUES  The values of designs by the objective of a study file, in MATLAB and in Octave.
  %
  %   values = retune_values('studies/tmd-free.json', X)
  %
  % X has a design in each row: one number for each tuned parameter, in the order k2 c2 D C m2, in SI units. A design that breaks a limit
  % is Inf, one without a value NaN. The numbers are those of `retune evaluate`, to the last bit.
  if nargin < 3
    program = 'retune';
  end
  name = tempname();
  file = fopen(name, 'w');
  fprintf(file, [repmat('%.17g ', 1, columns_of(X)) '\n'], X.');
  fclose(file);
  cleaner = onCleanup(@() delete(name));
  [~, answers] = system(sprintf('"%s" evaluate "%s" < "%s" 2> %s', program, study, name, nowhere()));
  values = str2double(strsplit(strtrim(answers), char(10))).';
  if numel(values) ~= size(X, 1)
    error('retune:evaluate', 'retune answered %d of %d designs: %s', numel(values), size(X, 1), answers);
  end
end

function count = columns_of(X)
  count = size(X, 2);
end

function name = nowhere()
  if ispc()
    name = 'NUL';
  else
    name = '/dev/null';
  end
end
