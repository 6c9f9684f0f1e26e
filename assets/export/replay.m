% Replays vectors.csv with ${prefix}.m: prints the largest deviation of each output; an error beyond the bound.
%
%     octave-cli replay.m          or          matlab -batch replay
%
% rows = 1000; replay              only the first rows
here = fileparts(mfilename('fullpath'));
vectors = dlmread(fullfile(here, 'vectors.csv'), ',', 1, 0);
if ~exist('rows', 'var') || isempty(rows)
    rows = size(vectors, 1);
end
inputs = {$input_names};
outputs = {$output_names};
bounds = [$bounds]; % of the peak of each output
found = zeros(rows, numel(outputs));
s = ${prefix}();
for row = 1:rows
    in = struct();
    for place = 1:numel(inputs)
        in.(inputs{place}) = ${typed}(vectors(row, place));
    end
    [s, out] = ${prefix}(s, in);
    for place = 1:numel(outputs)
        found(row, place) = double(out.(outputs{place}));
    end
end
expected = vectors(1:rows, numel(inputs) + 1:end);
within = true;
for place = 1:numel(outputs)
    peak = max(abs(vectors(:, numel(inputs) + place)));
    off = max(abs(found(:, place) - expected(:, place)));
    fprintf('%-22s peak %13.6g deviation %13.6g\n', outputs{place}, peak, off);
    within = within && off <= bounds(place) * peak;
end
if ~within
    error('replay:beyond', 'an output lies beyond its bound');
end
fprintf('%d steps: within the bounds\n', rows);
