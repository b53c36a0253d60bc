function [Q, P] = two_torus_series(t, amplitudes, phases, frequencies)
% TWO_TORUS_SERIES  Machine-written: a Poincare-Lindstedt series of a Fermi-Pasta-Ulam chain.
%   For GNU Octave and MATLAB, which need nothing else; do not edit.
%
%   Q_q(t) = sum over nu of c_q[nu](A) cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1,
%   with free amplitudes A, phases phi and frequencies omega of the seeds.
%
%   written by: symfpu 0.1.0
%   made by: symfpu export two_torus.symfpu --lang octave -o two_torus_series --series --order 3
%       --frequency-order 4
%   chain: Chain(N=16, alpha=0.33)
%   seeds: 1, 2
%   frequencies of the divisors: 0.19626, 0.39046
%   orders: frequencies 4, coordinates 3
%   precision: 30 digits
%   hash of the series: 1978bc5725bd9fa9918f10cf37fc7ccee026a7cb89aa0e44b5289a02f8ed0182
%
%   [Q, P] = two_torus_series(t, amplitudes)
%   [Q, P] = two_torus_series(t, amplitudes, phases)
%   [Q, P] = two_torus_series(t, amplitudes, phases, frequencies)
%   [omega, jacobian] = two_torus_series('corrected_frequencies', amplitudes)
%     t            vector of T real times, row or column
%     amplitudes   2 number(s) A, one a seed in the order above
%     phases       2 angles phi in radians; default, also of [], zeros
%     frequencies  2 rates omega of the angles; default omega(A) of the series
%     Q, P         T x (N-1) = T x 15, coordinates and momenta: column q is mode q
%     omega        1 x 2, corrected frequencies omega(A) of the seeds
%     jacobian     2 x 2, d omega_i / d A_j in row i, column j
%   All quantities are dimensionless.
%
%   Accuracy: omega t is reduced to one turn in two doubles, so that large times lose no digit of
%   the angle; the sums are those of doubles, some 1e-15 of the largest coordinate. Phases are as
%   good as their own last digit. MATLAB needs R2016b or later.
%
%   two_torus_series('self_test')
%   prints and returns the largest deviation from embedded vectors, relative to the largest
%   coordinate, momentum, frequency or slope, and is an error above 1e-13.

if nargin < 1
    refuseCall('arguments', 'give times and amplitudes, or ''self_test''');
end
if ischar(t) || isa(t, 'string')
    if strcmp(t, 'self_test')
        Q = selfTest();
    elseif ~strcmp(t, 'corrected_frequencies')
        refuseCall('word', 'the only words are ''corrected_frequencies'' and ''self_test''');
    elseif nargin ~= 2
        refuseCall('arguments', '''corrected_frequencies'' takes the amplitudes');
    else
        [Q, P] = correctedFrequencies(checkedRow('amplitudes', amplitudes));
    end
    return
end
if nargin < 2
    refuseCall('arguments', 'give times and amplitudes');
end
t = checkedTimes(t);
amplitudes = checkedRow('amplitudes', amplitudes);
if nargin < 3 || isempty(phases)
    phases = zeros(1, 2);
end
phases = checkedRow('phases', phases);
if nargin < 4 || isempty(frequencies)
    frequencies = correctedFrequencies(amplitudes);
end
frequencies = checkedRow('frequencies', frequencies);
if nargout < 2
    Q = seriesOrbit(t, amplitudes, phases, frequencies);
else
    [Q, P] = seriesOrbit(t, amplitudes, phases, frequencies);
end
end

function refuseCall(kind, message)
name = 'two_torus_series';
error([name ':' kind], '%s: %s', name, message);
end

function t = checkedTimes(t)
if ~isnumeric(t) || ~isreal(t) || (~isempty(t) && numel(t) ~= max(size(t)))
    refuseCall('shape', 't must be a real vector of times');
end
t = double(t(:));
end

function row = checkedRow(what, values)
if ~isnumeric(values) || ~isreal(values) || numel(values) ~= 2
    refuseCall('shape', [what ' must be 2 real number(s), one for each seed']);
end
row = reshape(double(values), 1, []);
end

function [Q, P] = seriesOrbit(t, A, phases, rates)
A1 = A(1);
A2 = A(2);
omega1 = rates(1);
omega2 = rates(2);

x0 = A1.^2;
x1 = A1.^4;
x2 = A2.^2;
x3 = x0 .* x2;
x4 = A2.^4;
x5 = A2 .* x0;
x6 = A2.^3;
x7 = A1.^3;
x8 = A1 .* x2;
x9 = 2*omega2;
x10 = -omega2;
x11 = A1 .* A2;
x12 = A2 .* x7;
x13 = A1 .* x6;
x14 = 2*omega1;
x15 = 3*omega2;
x16 = -x9;
x17 = 3*omega1;
c0_2 = -0.0028687032351990722*x0 + 3.981975731204928e-05*x1 - 0.0035713364733041936*x3;
c0_4 = -0.000406708251684491*x1 - 0.005801906708236072*x2 - 0.0001028515026733883*x3 + ...
    7.667301950445486e-05*x4;
c0_6 = -0.0010408166713117288*x3;
c0_8 = -0.00020060716303406162*x4;
rate1 = omega2;
c1_2 = 1.0*A2;
d1_2 = -c1_2 .* rate1;
c1_4 = -0.004039781598349474*x5;
d1_4 = -c1_4 .* rate1;
c1_6 = -0.002320270331342854*x6;
d1_6 = -c1_6 .* rate1;
rate2 = omega1;
c2_1 = 1.0*A1;
d2_1 = -c2_1 .* rate2;
c2_3 = 0.009609144222270698*A1 .* x2 - 0.002303123425996099*x7;
d2_3 = -c2_3 .* rate2;
c2_5 = -0.005047163976846871*x8;
d2_5 = -c2_5 .* rate2;
rate3 = x9;
c3_2 = -0.004792413558393184*x3;
d3_2 = -c3_2 .* rate3;
c3_4 = 0.14131948233035063*x2 - 0.14695492167776708*x3 + 0.014368474457199321*x4;
d3_4 = -c3_4 .* rate3;
c3_6 = -0.0013476891206633246*x3;
d3_6 = -c3_6 .* rate3;
c3_8 = -0.0003951786865153717*x4;
d3_8 = -c3_8 .* rate3;
rate4 = omega1 + x10;
c4_1 = 1.1173455145685154*A1 .* x6 - 1.087489189529932*x11 - 0.6363185137238475*x12;
d4_1 = -c4_1 .* rate4;
c4_3 = -0.008653976202413236*x11 + 4.7364636676905825e-06*x12 + 9.728805847404313e-05*x13;
d4_3 = -c4_3 .* rate4;
c4_5 = 0.006211803094997529*A1 .* x6 - 0.0013302049702459508*x12;
d4_5 = -c4_5 .* rate4;
c4_7 = -0.0009241366554937783*x13;
d4_7 = -c4_7 .* rate4;
rate5 = omega1 + omega2;
c5_1 = 0.002861155751656057*x11 - 0.0008970374368847945*x12 + 4.721718220062921e-06*x13;
d5_1 = -c5_1 .* rate5;
c5_3 = 0.36082081426335916*x11 - 0.013108564194709953*x12 + 0.03162233624033316*x13;
d5_3 = -c5_3 .* rate5;
c5_5 = 0.00213343820329272*A1 .* x6 - 0.0018278113797905548*x12;
d5_5 = -c5_5 .* rate5;
c5_7 = -0.0015661664830180406*x13;
d5_7 = -c5_7 .* rate5;
rate6 = x14;
c6_2 = 0.27115700844456897*x0 + 0.12035153297272662*x1 - 0.22278126771983983*x3;
d6_2 = -c6_2 .* rate6;
c6_4 = 0.004469710359303185*x0 .* x2 - 0.0008095643183902094*x1;
d6_4 = -c6_4 .* rate6;
c6_6 = -0.00218467016492829*x3;
d6_6 = -c6_6 .* rate6;
rate7 = x15;
c7_2 = 0.0007875878368247138*x6;
d7_2 = -c7_2 .* rate7;
c7_6 = 0.019895233780180387*x6;
d7_6 = -c7_6 .* rate7;
rate8 = omega1 + x16;
c8_1 = -0.003210142951212994*x8;
d8_1 = -c8_1 .* rate8;
c8_3 = -0.44037557830840124*x8;
d8_3 = -c8_3 .* rate8;
c8_5 = -0.0019347032245652866*x8;
d8_5 = -c8_5 .* rate8;
rate9 = omega1 + x9;
c9_1 = 0.0010227658453562675*x8;
d9_1 = -c9_1 .* rate9;
c9_3 = 0.0011743413403160225*x8;
d9_3 = -c9_3 .* rate9;
c9_5 = 0.0857534662498305*x8;
d9_5 = -c9_5 .* rate9;
rate10 = x10 + x14;
c10_2 = 0.006386591341743735*x5;
d10_2 = -c10_2 .* rate10;
c10_4 = -0.0030714067691627327*x5;
d10_4 = -c10_4 .* rate10;
rate11 = omega2 + x14;
c11_2 = 0.002034796453570815*x5;
d11_2 = -c11_2 .* rate11;
c11_4 = 0.13481870681336375*x5;
d11_4 = -c11_4 .* rate11;
rate12 = x17;
c12_1 = 0.0007697256811581401*x7;
d12_1 = -c12_1 .* rate12;
c12_3 = 0.07316275581276288*x7;
d12_3 = -c12_3 .* rate12;
rate13 = 4*omega2;
c13_4 = 0.00021065985386560155*x4;
d13_4 = -c13_4 .* rate13;
c13_8 = 0.0027180982348453714*x4;
d13_8 = -c13_8 .* rate13;
rate14 = omega1 - x15;
c14_1 = -0.0012595569830263697*x13;
d14_1 = -c14_1 .* rate14;
c14_3 = -0.0013218139253162947*x13;
d14_3 = -c14_3 .* rate14;
c14_5 = -0.10510386728889293*x13;
d14_5 = -c14_5 .* rate14;
c14_7 = -0.00034578434218557493*x13;
d14_7 = -c14_7 .* rate14;
rate15 = omega1 + x15;
c15_1 = 0.00014396810949383098*x13;
d15_1 = -c15_1 .* rate15;
c15_3 = 0.0007011495712170275*x13;
d15_3 = -c15_3 .* rate15;
c15_5 = 0.00026112212247840586*x13;
d15_5 = -c15_5 .* rate15;
c15_7 = 0.01662447386665833*x13;
d15_7 = -c15_7 .* rate15;
rate16 = x14 + x16;
c16_2 = 0.22587682658901168*x3;
d16_2 = -c16_2 .* rate16;
c16_4 = 0.004972073555398954*x3;
d16_4 = -c16_4 .* rate16;
c16_6 = -0.0006089354170374815*x3;
d16_6 = -c16_6 .* rate16;
rate17 = x14 + x9;
c17_2 = 0.0009665139899628146*x3;
d17_2 = -c17_2 .* rate17;
c17_4 = 0.0009260643965836509*x3;
d17_4 = -c17_4 .* rate17;
c17_6 = 0.04075813463519515*x3;
d17_6 = -c17_6 .* rate17;
rate18 = x10 + x17;
c18_1 = -0.08393514749379542*x12;
d18_1 = -c18_1 .* rate18;
c18_3 = 0.0025559028660708237*x12;
d18_3 = -c18_3 .* rate18;
c18_5 = -0.0010087211758185608*x12;
d18_5 = -c18_5 .* rate18;
rate19 = omega2 + x17;
c19_1 = 0.00048470538167331154*x12;
d19_1 = -c19_1 .* rate19;
c19_3 = 0.0011166044853950544*x12;
d19_3 = -c19_3 .* rate19;
c19_5 = 0.04629444016810897*x12;
d19_5 = -c19_5 .* rate19;
rate20 = 4*omega1;
c20_2 = 0.0004100749283565843*x1;
d20_2 = -c20_2 .* rate20;
c20_4 = 0.020381730629727663*x1;
d20_4 = -c20_4 .* rate20;
[high, low] = turnsOf(rates);
Q = zeros(numel(t), 15);
P = Q;
for first = 1:1024:numel(t)
    rows = first:min(first + 1023, numel(t));
    theta = reducedAngles(t(rows), high, low, phases);
    theta1 = theta(:, 1);
    theta2 = theta(:, 2);
    cos1 = cos(theta2);
    sin1 = sin(theta2);
    cos2 = cos(theta1);
    sin2 = sin(theta1);
    cos3 = cos(2*theta2);
    sin3 = sin(2*theta2);
    cos4 = cos(theta1 - theta2);
    sin4 = sin(theta1 - theta2);
    cos5 = cos(theta1 + theta2);
    sin5 = sin(theta1 + theta2);
    cos6 = cos(2*theta1);
    sin6 = sin(2*theta1);
    cos7 = cos(3*theta2);
    sin7 = sin(3*theta2);
    cos8 = cos(theta1 - 2*theta2);
    sin8 = sin(theta1 - 2*theta2);
    cos9 = cos(theta1 + 2*theta2);
    sin9 = sin(theta1 + 2*theta2);
    cos10 = cos(2*theta1 - theta2);
    sin10 = sin(2*theta1 - theta2);
    cos11 = cos(2*theta1 + theta2);
    sin11 = sin(2*theta1 + theta2);
    cos12 = cos(3*theta1);
    sin12 = sin(3*theta1);
    cos13 = cos(4*theta2);
    sin13 = sin(4*theta2);
    cos14 = cos(theta1 - 3*theta2);
    sin14 = sin(theta1 - 3*theta2);
    cos15 = cos(theta1 + 3*theta2);
    sin15 = sin(theta1 + 3*theta2);
    cos16 = cos(2*theta1 - 2*theta2);
    sin16 = sin(2*theta1 - 2*theta2);
    cos17 = cos(2*theta1 + 2*theta2);
    sin17 = sin(2*theta1 + 2*theta2);
    cos18 = cos(3*theta1 - theta2);
    sin18 = sin(3*theta1 - theta2);
    cos19 = cos(3*theta1 + theta2);
    sin19 = sin(3*theta1 + theta2);
    cos20 = cos(4*theta1);
    sin20 = sin(4*theta1);
    Q(rows, 1) = c12_1 .* cos12 + c14_1 .* cos14 + c15_1 .* cos15 + c18_1 .* cos18 + c19_1 .* cos19 + ...
        c2_1 .* cos2 + c4_1 .* cos4 + c5_1 .* cos5 + c8_1 .* cos8 + c9_1 .* cos9;
    Q(rows, 2) = c0_2 + c10_2 .* cos10 + c11_2 .* cos11 + c16_2 .* cos16 + c17_2 .* cos17 + c1_2 .* cos1 ...
        + c20_2 .* cos20 + c3_2 .* cos3 + c6_2 .* cos6 + c7_2 .* cos7;
    Q(rows, 3) = c12_3 .* cos12 + c14_3 .* cos14 + c15_3 .* cos15 + c18_3 .* cos18 + c19_3 .* cos19 + ...
        c2_3 .* cos2 + c4_3 .* cos4 + c5_3 .* cos5 + c8_3 .* cos8 + c9_3 .* cos9;
    Q(rows, 4) = c0_4 + c10_4 .* cos10 + c11_4 .* cos11 + c13_4 .* cos13 + c16_4 .* cos16 + c17_4 .* ...
        cos17 + c1_4 .* cos1 + c20_4 .* cos20 + c3_4 .* cos3 + c6_4 .* cos6;
    Q(rows, 5) = c14_5 .* cos14 + c15_5 .* cos15 + c18_5 .* cos18 + c19_5 .* cos19 + c2_5 .* cos2 + c4_5 ...
        .* cos4 + c5_5 .* cos5 + c8_5 .* cos8 + c9_5 .* cos9;
    Q(rows, 6) = c0_6 + c16_6 .* cos16 + c17_6 .* cos17 + c1_6 .* cos1 + c3_6 .* cos3 + c6_6 .* cos6 + ...
        c7_6 .* cos7;
    Q(rows, 7) = c14_7 .* cos14 + c15_7 .* cos15 + c4_7 .* cos4 + c5_7 .* cos5;
    Q(rows, 8) = c0_8 + c13_8 .* cos13 + c3_8 .* cos3;
    if nargout > 1
        P(rows, 1) = d12_1 .* sin12 + d14_1 .* sin14 + d15_1 .* sin15 + d18_1 .* sin18 + d19_1 .* sin19 + ...
            d2_1 .* sin2 + d4_1 .* sin4 + d5_1 .* sin5 + d8_1 .* sin8 + d9_1 .* sin9;
        P(rows, 2) = d10_2 .* sin10 + d11_2 .* sin11 + d16_2 .* sin16 + d17_2 .* sin17 + d1_2 .* sin1 + ...
            d20_2 .* sin20 + d3_2 .* sin3 + d6_2 .* sin6 + d7_2 .* sin7;
        P(rows, 3) = d12_3 .* sin12 + d14_3 .* sin14 + d15_3 .* sin15 + d18_3 .* sin18 + d19_3 .* sin19 + ...
            d2_3 .* sin2 + d4_3 .* sin4 + d5_3 .* sin5 + d8_3 .* sin8 + d9_3 .* sin9;
        P(rows, 4) = d10_4 .* sin10 + d11_4 .* sin11 + d13_4 .* sin13 + d16_4 .* sin16 + d17_4 .* sin17 + ...
            d1_4 .* sin1 + d20_4 .* sin20 + d3_4 .* sin3 + d6_4 .* sin6;
        P(rows, 5) = d14_5 .* sin14 + d15_5 .* sin15 + d18_5 .* sin18 + d19_5 .* sin19 + d2_5 .* sin2 + d4_5 ...
            .* sin4 + d5_5 .* sin5 + d8_5 .* sin8 + d9_5 .* sin9;
        P(rows, 6) = d16_6 .* sin16 + d17_6 .* sin17 + d1_6 .* sin1 + d3_6 .* sin3 + d6_6 .* sin6 + d7_6 .* ...
            sin7;
        P(rows, 7) = d14_7 .* sin14 + d15_7 .* sin15 + d4_7 .* sin4 + d5_7 .* sin5;
        P(rows, 8) = d13_8 .* sin13 + d3_8 .* sin3;
    end
end
end

function [omega, jacobian] = correctedFrequencies(A)
A1 = A(1);
A2 = A(2);
% coefficients are those of the chosen frequencies

y0 = A1.^2;
y1 = A1.^4;
y2 = A2.^2;
y3 = A2.^4;
y4 = y0 .* y2;
y5 = A1.^3;
y6 = A2.^3;
y7 = A2 .* y0;
omega = zeros(1, 2);
jacobian = zeros(2, 2);
omega(1) = 0.000592160852870222*y0 + 0.00039529957083372116*y1 - 9.294742582813598e-05*y2 + ...
    0.0021470587971840756*y3 - 0.001402329305497235*y4 + 0.1960342806591212;
omega(2) = -4.6698579337598625e-05*y0 - 0.0004451823698547334*y1 + 0.0011298915795266533*y2 + ...
    0.00018810304175985085*y3 + 0.0021023772176948768*y4 + 0.39018064403225655;
jacobian(1, 1) = -0.00280465861099447*A1 .* y2 + 0.001184321705740444*A1 + 0.0015811982833348847*y5;
jacobian(1, 2) = -0.00018589485165627196*A2 + 0.008588235188736302*y6 - 0.00280465861099447*y7;
jacobian(2, 1) = 0.0042047544353897535*A1 .* y2 - 9.339715867519725e-05*A1 - ...
    0.0017807294794189336*y5;
jacobian(2, 2) = 0.0022597831590533066*A2 + 0.0007524121670394034*y6 + 0.0042047544353897535*y7;
end

function worst = selfTest()
A = testAmplitudes().';
rates = testFrequencies().';
found = cell(1, 4);
[found{1}, found{2}] = seriesOrbit(testTimes(), A, testPhases().', rates);
[found{3}, found{4}] = correctedFrequencies(A);
known = {reshape(testPositions(), 15, []).', reshape(testMomenta(), 15, []).', ...
    testCorrected().', reshape(testJacobian(), 2, []).'};
worst = largestDeviation(found, known);
end

function worst = largestDeviation(found, known)
% Of every kind of number relative to the largest of its kind; an error above the tolerance.
gaps = 0;
for k = 1:numel(known)
    scale = max(abs(known{k}(:)));
    if scale == 0
        scale = 1;
    end
    gaps = [gaps; abs(found{k}(:) - known{k}(:)) / scale]; %#ok<AGROW>
end
worst = max(gaps);
if any(isnan(gaps))
    worst = NaN;
end
fprintf('largest deviation %.1e, allowed %.0e\n', worst, 1e-13);
if ~(worst <= 1e-13)
    refuseCall('self_test', sprintf('the self-test failed: deviation %.1e, allowed %.0e', worst, 1e-13));
end
end

function [high, low] = turnsOf(frequencies)
% omega / 2 pi as the sum of two doubles.
[high, low] = exactProduct(frequencies, 0.15915494309189535);
low = low + frequencies * -9.839338337591243e-18;
end

function [product, rest] = exactProduct(a, b)
% a b as the sum of two doubles (Dekker).
big = 134217729 * a;
a_high = big - (big - a);
a_low = a - a_high;
big = 134217729 * b;
b_high = big - (big - b);
b_low = b - b_high;
product = a .* b;
rest = ((a_high .* b_high - product) + a_high .* b_low + a_low .* b_high) + a_low .* b_low;
end

function theta = reducedAngles(t, high, low, phases)
% omega t + phi modulo 2 pi, T x s; high + low = omega / 2 pi, so that large times lose no digit of the angle.
[product, rest] = exactProduct(t, high);
theta = 2 * pi * ((product - round(product)) + rest + t * low) + phases;
end

function values = testAmplitudes()
parts = cell(1, 1);
parts{1} = [ ...
'0.182861328125 0.06884765625 '];
values = sscanf([parts{:}], '%f');
end

function values = testPhases()
parts = cell(1, 1);
parts{1} = [ ...
'0.5 0.125 '];
values = sscanf([parts{:}], '%f');
end

function values = testFrequencies()
parts = cell(1, 1);
parts{1} = [ ...
'0.1972370147705078125 0.39241313934326171875 '];
values = sscanf([parts{:}], '%f');
end

function values = testTimes()
parts = cell(1, 1);
parts{1} = [ ...
'0.0 2.75 -13.0625 160.5 '];
values = sscanf([parts{:}], '%f');
end

function values = testCorrected()
parts = cell(1, 1);
parts{1} = [ ...
'0.19605390888520602458332167486298 0.39018427787984442035971972714657 '];
values = sscanf([parts{:}], '%f');
end

function values = testPositions()
parts = cell(1, 1);
parts{1} = [ ...
'0.14756933146808631054049064018559 0.073203598579172561204294549016604 ' ...
'0.0032371865341353006424473159515961 0.00070990711452824634689287541819119 ' ...
'0.000040872487298711644697240515639449 0.0000066974629388337557750012123437254 ' ...
'0.00000048832480163410778342118505274191 0.000000040483351493464394303731535833488 0.0 0.0 0.0 0.0 ' ...
'0.0 0.0 0.0 0.078461925196820876617223557143709 0.020117360126198514575263066765994 ' ...
'-0.0034758632725270665951605181182657 -0.00083438102682484172249590100107699 ' ...
'-0.000074964718909367909998571288491873 -0.0000073905944562408347943094375558558 ' ...
'-0.000000035705977692847778953265316443966 0.0000000084385299202670478741849835677274 0.0 0.0 0.0 ' ...
'0.0 0.0 0.0 0.0 -0.074982746237819438006039687656717 0.014664471290773599650332861442654 ' ...
'0.0037658052572687938674731867293416 -0.00088561150807295660888356709127249 ' ...
'0.0000661325292037646578624050365095 -0.000005161480036256057274854789902394 ' ...
'-0.00000022772925003915493882021715731503 0.000000027655143601907189698422123317885 0.0 0.0 0.0 0.0 ' ...
'0.0 0.0 0.0 0.12257154512285745899428013581214 0.067000433939930320757999202973042 ' ...
'0.001642569080249164793528182850231 0.0004323357884905223178884943106208 ' ...
'-0.0000065690659572436310966802339133091 0.00000035908190795228430061260862179201 ' ...
'-0.00000011528901354948065404775004133311 0.000000015529201196980878139321730934179 0.0 0.0 0.0 0.0 ' ...
'0.0 0.0 0.0 '];
values = sscanf([parts{:}], '%f');
end

function values = testMomenta()
parts = cell(1, 1);
parts{1} = [ ...
'-0.018293958133367806902373287972942 -0.0064052296662361845906304435994221 ' ...
'-0.0018941334653236956743872074806609 -0.00036173950781266521182799194915859 ' ...
'-0.000069229031114028206365465286530385 -0.0000098614496536706857437076625333305 ' ...
'-0.0000010208118122642845145228512260799 -0.000000044232478903611519644472869551662 0.0 0.0 0.0 0.0 ' ...
'0.0 0.0 0.0 -0.03071921776843878393154032644423 -0.028372443100290810668913337715686 ' ...
'-0.001867419146978509780792483803516 -0.00028500310934264713550961397164586 ' ...
'0.000045444713955013251251655471615274 0.000011423481941104009767149446414489 ' ...
'0.000001416972223634133176658469681818 0.00000010000197985706274868923876963484 0.0 0.0 0.0 0.0 0.0 ' ...
'0.0 0.0 0.030976134246780824748447943215058 -0.028968375116062573055984834372863 ' ...
'0.0016645665444151503035059725572622 -0.00019176267342690542195525255515204 ' ...
'-0.000057170630602177413015844374003584 0.000013079815310952005725273481887676 ' ...
'-0.0000013852189261740850174603172256455 0.000000091453580155181368838079391064676 0.0 0.0 0.0 0.0 ' ...
'0.0 0.0 0.0 -0.025566967163580699181108752880674 -0.010942105830984037553380330982304 ' ...
'-0.0025381675152384090157509133528406 -0.00050781442284462610028381364977074 ' ...
'-0.000080400969593579609531547926320307 -0.000012168941068547169274219672019181 ' ...
'-0.0000013198021611507604897854530555025 -0.000000081860258330294300897548902612188 0.0 0.0 0.0 0.0 ' ...
'0.0 0.0 0.0 '];
values = sscanf([parts{:}], '%f');
end

function values = testJacobian()
parts = cell(1, 1);
parts{1} = [ ...
'0.00022380400734081573238975970204455 -0.000016452492579182645347796173046122 ' ...
'-0.000024322591597605420313141178032022 0.00016550627415271873940175195396255 '];
values = sscanf([parts{:}], '%f');
end
