% The network of ${prefix} as objects: H(s), Q(s) = 1 - H(s), and Q in discrete time as it runs (one channel).
%
% [H, Q, Qd] = ${prefix}_objects() gives tf and ss objects with sample time where the Control System Toolbox (or
% Octave's package control) is there, else structures with the same numbers.
function [H, Q, Qd] = ${prefix}_objects()
$numbers
    if exist('ss') && exist('tf')
        H = tf(num, den);
        Q = tf(qnum, den);
        Qd = ss(eye(size(dA)) + dA, B, C, D, Ts);
    else
        H = struct('num', num, 'den', den);
        Q = struct('num', qnum, 'den', den);
        Qd = struct('A', eye(size(dA)) + dA, 'B', B, 'C', C, 'D', D, 'Ts', Ts);
    end
end
