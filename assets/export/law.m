function [s, out] = ${prefix}(s, in)
% $title
%
% Made by Schuler Bench $version from the scenario "$scenario"
% (SHA-256 $sha256), method "$method":
% $description
%
% This file is yours: use, change and pass it on as you like.
%
%     s = ${prefix}();               the state before the first call
%     [s, out] = ${prefix}(s, in);   every $step_s s ($rate_hz Hz), always at this rate
%
% Axes: east, north, up. Rates are positive about them, yaw is clockwise from north. SI units and radians.
% log_valid: 0 invalid, 1 a sample, 2 none yet (the last one holds for at most $hold_s s).
$usage
%
% in:
$in_fields
% out:
$out_fields
    if nargin == 0
        s = start_fn();
        return
    end
$call
end

function s = start_fn()
    % The state before the first call, and the constants.
    k = struct();
$constants
    s = struct('k', k);
$initial
end

$functions

function y = pick_fn(condition, first, second)
    % One of two values.
    if condition
        y = first;
    else
        y = second;
    end
end
