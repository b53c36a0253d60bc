function [Q, P, E, H] = breather_25(t, phases)
% BREATHER_25  Machine-written: a quasi-periodic solution of a Fermi-Pasta-Ulam chain.
%   For GNU Octave and MATLAB, which need nothing else; do not edit.
%
%   Q_q(t) = sum over nu of c_q[nu] cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1.
%
%   written by: symfpu 0.1.0
%   made by: symfpu export breather_25.symfpu --lang octave -o breather_25
%   orders: frequencies 12, coordinates 12
%   amplitudes: A_25 = 0.0512121591740189630941015617021
%   chain: Chain(N=32, alpha=0.33)
%   seeds: 25
%   frequencies: 1.8830741847088537
%   precision: 30 digits
%   hash of the coefficients: 1dcd398567a325e662ff3b53541cc134d88044b6eb5a24368358e04cb7f01601
%
%   [Q, P, E, H] = breather_25(t)
%   [Q, P, E, H] = breather_25(t, phases)
%     t       vector of T real times, row or column
%     phases  1 angles phi in radians, one a seed in the order above; default
%             0.0
%     Q, P    T x (N-1) = T x 31, coordinates and momenta: column q is mode q
%     E       T x 31, E_q = (P_q^2 + Omega_q^2 Q_q^2) / 2, the energy of mode q
%     H       T x 1, total energy of the chain
%   All quantities are dimensionless. What is not asked for is not computed.
%
%   Accuracy: omega t is reduced to one turn in two doubles, so that large times lose no digit of
%   the angle; the sums are those of doubles, some 1e-15 of the largest coordinate. Phases are as
%   good as their own last digit. MATLAB needs R2016b or later.
%
%   breather_25('self_test')
%   prints and returns the largest deviation from embedded vectors, relative to the largest
%   coordinate, momentum or energy, and is an error above 1e-13.

if nargin < 1
    refuseCall('arguments', 'give a vector of times, or ''self_test''');
end
if ischar(t) || isa(t, 'string')
    if ~strcmp(t, 'self_test')
        refuseCall('word', 'the only word is ''self_test''');
    end
    Q = selfTest();
    return
end
if nargin < 2 || isempty(phases)
    phases = [0.0];
end
t = checkedTimes(t);
phases = checkedRow('phases', phases);
if nargout < 2
    Q = torusOrbit(t, phases);
else
    [Q, P] = torusOrbit(t, phases);
end
if nargout > 2
    E = 0.5 * (P .^ 2 + (Q .* linearFrequencies()) .^ 2);
end
if nargout > 3
    H = totalEnergy(Q, P);
end
end

function refuseCall(kind, message)
name = 'breather_25';
error([name ':' kind], '%s: %s', name, message);
end

function t = checkedTimes(t)
if ~isnumeric(t) || ~isreal(t) || (~isempty(t) && numel(t) ~= max(size(t)))
    refuseCall('shape', 't must be a real vector of times');
end
t = double(t(:));
end

function row = checkedRow(what, values)
if ~isnumeric(values) || ~isreal(values) || numel(values) ~= 1
    refuseCall('shape', [what ' must be 1 real number(s), one for each seed']);
end
row = reshape(double(values), 1, []);
end

function [Q, P] = torusOrbit(t, phases)
persistent plan weights
modes = {[2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30], ...
    [1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31]};
if isempty(plan)
    omega = [1.8830741847088537];
    harmonics = {reshape(harmonicTable1(), 1, []).', ...
    reshape(harmonicTable2(), 1, []).'};
    coefficients = {reshape(coefficientTable1(), 15, []).', ...
    reshape(coefficientTable2(), 16, []).'};
    plan = plannedSums(harmonics);
    weights = weightedParts(plan, coefficients, omega);
end
% omega / 2 pi as the sum of two doubles
high = [0.2997005647051548];
low = [-9.350283012835618e-18];
if nargout < 2
    Q = summedOrbit(t, high, low, phases, plan, weights, modes);
else
    [Q, P] = summedOrbit(t, high, low, phases, plan, weights, modes);
end
end

function linear = linearFrequencies()
linear = 2 * sin((1:31) * (pi / 64));
end

function H = totalEnergy(Q, P)
bonds = cos((1:31).' * ((0:31) + 0.5) * (pi / 32)) * sqrt(2 / 32);
r = (Q .* linearFrequencies()) * bonds;
H = 0.5 * sum(P .^ 2, 2) + sum(r .^ 2 .* (0.5 + r .* (0.33 / 3 + r * (0.0 / 4))), 2);
end

function worst = selfTest()
t = testTimes();
[Q, P] = torusOrbit(t, [0.0]);
found = {Q, P, totalEnergy(Q, P)};
known = {reshape(testPositions(), 31, []).', reshape(testMomenta(), 31, []).', testEnergies()};
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

function signs = firstSigns(rows)
% Sign of the first number of every row that is not zero; 1 where all are.
signs = ones(size(rows, 1), 1);
for j = size(rows, 2):-1:1
    signs(rows(:, j) > 0) = 1;
    signs(rows(:, j) < 0) = -1;
end
end

function plan = plannedSums(harmonics)
% Harmonics (a cell for every block) as a >= 0 times the first angle, and a sign times one of few trailing parts b:
% cos(a x + b.y) = cos(a x) cos(b.y) - sin(a x) sin(b.y). One seed alone is trailing.
plan.split = min(1, 1 - 1);
plan.trailing = zeros(0, 1 - plan.split);
plan.harmonics = cell(size(harmonics));
plan.parts = cell(size(harmonics));
if isempty(harmonics)
    return
end
all_rows = vertcat(harmonics{:});
all_rows = all_rows .* firstSigns(all_rows);
leading = sum(all_rows(:, 1:plan.split), 2);
signs = firstSigns(all_rows(:, plan.split+1:end));
[plan.trailing, unused, where] = unique(all_rows(:, plan.split+1:end) .* signs, 'rows'); %#ok<ASGLU>
done = 0;
for k = 1:numel(harmonics)
    mine = done + (1:size(harmonics{k}, 1)).';
    done = done + numel(mine);
    plan.harmonics{k} = all_rows(mine, :);
    multiples = unique(leading(mine));
    plan.parts{k} = cell(1, numel(multiples));
    for i = 1:numel(multiples)
        part.leading = multiples(i);
        part.rows = find(leading(mine) == multiples(i));
        [part.used, unused, place] = unique(where(mine(part.rows))); %#ok<ASGLU>
        order = (1:numel(place)).';
        part.even = sparse(place, order, 1);
        part.odd = sparse(place, order, signs(mine(part.rows)));
        plan.parts{k}{i} = part;
    end
end
end

function weights = weightedParts(plan, coefficients, omega)
% Coefficients of the products of cosines and of sines in Q, then those in P.
weights = cell(size(coefficients));
for k = 1:numel(coefficients)
    c = coefficients{k};
    r = c .* (plan.harmonics{k} * omega(:));
    weights{k} = cell(numel(plan.parts{k}), 4);
    for i = 1:numel(plan.parts{k})
        part = plan.parts{k}{i};
        weights{k}{i, 1} = full(part.even * c(part.rows, :));
        weights{k}{i, 2} = full(part.odd * c(part.rows, :));
        weights{k}{i, 3} = full(part.even * r(part.rows, :));
        weights{k}{i, 4} = full(part.odd * r(part.rows, :));
    end
end
end

function [q, p] = summedBlock(plan, parts, weights, x, cosines, sines)
% The modes of one parity at few times; p only where it is asked for.
q = 0;
p = 0;
for i = 1:numel(parts)
    used = parts{i}.used;
    even = cosines(:, used);
    odd = sines(:, used);
    a = parts{i}.leading;
    if a == 0
        q = q + even * weights{i, 1};
        if nargout > 1
            p = p - odd * weights{i, 4};
        end
        continue
    end
    c = cos(a * x);
    s = sin(a * x);
    q = q + c .* (even * weights{i, 1}) - s .* (odd * weights{i, 2});
    if nargout > 1
        p = p - s .* (even * weights{i, 3}) - c .* (odd * weights{i, 4});
    end
end
end

function [Q, P] = summedOrbit(t, high, low, phases, plan, weights, modes)
% All modes at all times, 128 times together.
Q = zeros(numel(t), 31);
P = Q;
for first = 1:128:numel(t)
    rows = first:min(first + 127, numel(t));
    theta = reducedAngles(t(rows), high, low, phases);
    angles = theta(:, plan.split+1:end) * plan.trailing.';
    cosines = cos(angles);
    sines = sin(angles);
    for k = 1:numel(modes)
        if nargout < 2
            Q(rows, modes{k}) = summedBlock(plan, plan.parts{k}, weights{k}, theta(:, 1), cosines, sines);
        else
            [Q(rows, modes{k}), P(rows, modes{k})] = ...
                summedBlock(plan, plan.parts{k}, weights{k}, theta(:, 1), cosines, sines);
        end
    end
end
end

function values = harmonicTable1()
parts = cell(1, 1);
parts{1} = [ ...
'0 2 4 6 8 10 12 '];
values = sscanf([parts{:}], '%f');
end

function values = coefficientTable1()
parts = cell(1, 1);
parts{1} = [ ...
'0.0 0.0 -2.7675140646771417e-22 4.2461145535150117e-19 0.0 0.0 0.00015117757854294937 0.0 0.0 ' ...
'-1.0786315577174035e-26 3.5508781926641617e-15 0.0 0.0 4.504624101242449e-10 0.0 0.0 0.0 ' ...
'6.475573571247884e-24 -1.1054425924466878e-20 0.0 0.0 -1.9354829168338714e-05 0.0 0.0 ' ...
'3.0277387632139386e-27 4.278296790564035e-15 0.0 0.0 -5.292931896694843e-10 0.0 0.0 0.0 ' ...
'-5.076568596010796e-27 -6.547434405602579e-22 0.0 0.0 -1.4244560699063556e-12 0.0 0.0 ' ...
'-8.798943565472705e-31 -4.001853415188579e-17 0.0 0.0 9.551077410701395e-13 0.0 0.0 0.0 ' ...
'3.1250813276403224e-29 1.2259705351549925e-24 0.0 0.0 -1.183771896274435e-19 0.0 0.0 ' ...
'1.1935546690289248e-33 3.0741888457648474e-20 0.0 0.0 7.692810797179155e-20 0.0 0.0 0.0 ' ...
'-3.404492072400157e-32 -5.188629273502791e-28 0.0 0.0 -8.135185521021295e-27 0.0 0.0 ' ...
'-2.9553264933332913e-36 2.932636965630418e-27 0.0 0.0 5.968105559678107e-27 0.0 0.0 0.0 ' ...
'1.0417857514940804e-35 -6.110739151851142e-35 0.0 0.0 -5.504373572318875e-34 0.0 0.0 ' ...
'2.1473604921341954e-39 2.4194676631029753e-34 0.0 0.0 4.184160810296171e-34 0.0 0.0 0.0 ' ...
'1.4304130218360944e-42 -5.547002995267631e-42 0.0 0.0 -3.58516483825606e-41 0.0 0.0 ' ...
'-4.951770626469579e-43 1.7909980366397718e-41 0.0 0.0 2.839524050376225e-41 0.0 '];
values = sscanf([parts{:}], '%f');
end

function values = harmonicTable2()
parts = cell(1, 1);
parts{1} = [ ...
'1 3 5 7 9 11 13 '];
values = sscanf([parts{:}], '%f');
end

function values = coefficientTable2()
parts = cell(1, 1);
parts{1} = [ ...
'0.0 1.0085362127709726e-12 -3.0009165730556703e-29 0.0 0.0 5.901180334736764e-07 0.0 0.0 ' ...
'-6.263956347261713e-17 -3.0478218234177374e-24 0.0 0.0 0.051212159174018966 0.0 0.0 ' ...
'1.9848962258524294e-20 0.0 -4.41680461344106e-14 4.119927956461746e-31 0.0 0.0 ' ...
'-3.255064309203764e-09 0.0 0.0 -2.8137710311924094e-18 2.8204532207813212e-27 0.0 0.0 ' ...
'6.484677900176531e-09 0.0 0.0 -9.677505243551741e-24 0.0 3.592700000494951e-17 ' ...
'-8.821734306051385e-35 0.0 0.0 -3.170787737648405e-16 0.0 0.0 8.298014009276822e-21 ' ...
'-4.2381937600831196e-30 0.0 0.0 5.078046961673205e-16 0.0 0.0 2.3109989565631162e-25 0.0 ' ...
'3.953076109854066e-24 1.4941832672044366e-37 0.0 0.0 -2.4000856282382192e-23 0.0 0.0 ' ...
'-4.18925397951177e-24 1.4397579899091643e-32 0.0 0.0 3.6674735063896916e-23 0.0 0.0 ' ...
'-3.393665481940952e-28 0.0 3.277552578540149e-31 -2.6891346357676717e-40 0.0 0.0 ' ...
'-1.666762440682117e-30 0.0 0.0 -5.066825016153425e-31 -1.232681963069093e-35 0.0 0.0 ' ...
'2.488274267685113e-30 0.0 0.0 1.1402004196781838e-31 0.0 2.407459837840973e-38 1.64993122821882e-43 ' ...
'0.0 0.0 -1.1151673796019302e-37 0.0 0.0 -4.464623590164244e-38 3.06140035403912e-39 0.0 0.0 ' ...
'1.6174572296711147e-37 0.0 0.0 1.5188423173611879e-38 0.0 1.6707763393820603e-45 ' ...
'-3.307432135185679e-47 0.0 0.0 -7.255980735885705e-45 0.0 0.0 -3.4421120634491285e-45 ' ...
'4.595750834750287e-46 0.0 0.0 1.0284125712579862e-44 0.0 0.0 1.4511214638955135e-45 '];
values = sscanf([parts{:}], '%f');
end

function values = testTimes()
parts = cell(1, 1);
parts{1} = [ ...
'0.0 1.234375 137.796875 '];
values = sscanf([parts{:}], '%f');
end

function values = testPositions()
parts = cell(1, 1);
parts{1} = [ ...
'0.0 0.0 9.6440409364052008165499232996776e-13 0.0 -2.9597261003104011324518384501783e-29 ' ...
'-2.7028087824828353612627044658721e-22 0.0 4.1290351143814618220684083397156e-19 0.0 0.0 ' ...
'0.0000005868629688473939242294794023275 0.0 0.0 0.00013182274795015445770040603026997 0.0 0.0 ' ...
'-6.5445040679054746831536312709047e-17 0.0 -3.0450055940054600582074943427999e-24 ' ...
'-7.7594555177151547227975623413661e-27 0.0 7.7891871909677003844228580151139e-15 0.0 0.0 ' ...
'0.051212165658697371075365183981197 0.0 0.0 -7.7875671727241077905956901835428e-11 0.0 0.0 ' ...
'1.9839515513923868630958605733484e-20 0.0 0.0 -7.2416795534025706137824155930722e-13 0.0 ' ...
'2.0852512350817767652198639537708e-29 -2.7715760804947483649937791789606e-22 0.0 ' ...
'4.2596318073993593371222637787488e-19 0.0 0.0 -0.00000040631949216112398908701451287024 0.0 0.0 ' ...
'0.00015240674362398792260348514720019 0.0 0.0 4.0698233852054821407212547672128e-17 0.0 ' ...
'2.0877527894843911774333883638429e-24 -1.0977724620074538034165200291218e-26 0.0 ' ...
'3.3188787257677141793481901708937e-15 0.0 0.0 -0.035043730852875582750097487966043 0.0 0.0 ' ...
'4.8312873427862796145936814247648e-10 0.0 0.0 -1.3589683746960515290262964457926e-20 0.0 0.0 ' ...
'-3.3303655987521256727667129246487e-13 0.0 9.2012573956782559532254968658523e-30 ' ...
'-2.820952360229937906256451348854e-22 0.0 4.3349463894918925334825064396725e-19 0.0 0.0 ' ...
'-0.00000017713766384896411866820450628041 0.0 0.0 0.00016714428250076417464790258827856 0.0 0.0 ' ...
'1.6317659798916568301361175685412e-17 0.0 9.0391025485799071162074646825746e-25 ' ...
'-1.3284356426064079247121726053589e-26 0.0 7.0683028114628598409806617892134e-18 0.0 0.0 ' ...
'-0.015151058139371609272742935180684 0.0 0.0 8.8744600056298917715881904794973e-10 0.0 0.0 ' ...
'-5.8801122261358461123552647456841e-21 '];
values = sscanf([parts{:}], '%f');
end

function values = testMomenta()
parts = cell(1, 1);
parts{1} = [ ...
'0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 ' ...
'0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 -1.2257722678242292700758364098964e-12 0.0 ' ...
'3.9725215784649382930730548838142e-29 2.4343241552803088369166746823374e-23 0.0 ' ...
'-4.0937039815554097571532303723687e-20 0.0 0.0 -0.00000079862308195406574124232296116339 0.0 0.0 ' ...
'-0.000072746015150619979159315197453489 0.0 0.0 9.6196743034423339799669641845857e-17 0.0 ' ...
'4.1749854608382265744791091404612e-24 1.1380722383753839172306237070612e-26 0.0 ' ...
'1.6118043039990650924770775031544e-14 0.0 0.0 -0.070322742974169949390105237819482 0.0 0.0 ' ...
'-0.0000000019902847337896515905999748180306 0.0 0.0 -2.7219327532445611421879404095884e-20 0.0 0.0 ' ...
'-1.9690551961773691095601866962299e-12 0.0 5.5424755968714802727295199253722e-29 ' ...
'1.3820336774722671186856740089541e-23 0.0 -1.8918681029217840852186931673723e-20 0.0 0.0 ' ...
'-0.0000010729069104971859661066581776606 0.0 0.0 -0.000041199959461840421412424587872843 0.0 0.0 ' ...
'1.0280128098752744449636638524754e-16 0.0 5.4922485646543797793818993973013e-24 ' ...
'6.4512386436229887310112846620392e-27 0.0 9.3884995959540997069833311221484e-15 0.0 0.0 ' ...
'-0.09211927600971585215349639942216 0.0 0.0 -0.0000000011333973049153176306124576377104 0.0 0.0 ' ...
'-3.5737961449745373298050618739078e-20 '];
values = sscanf([parts{:}], '%f');
end

function values = testEnergies()
parts = cell(1, 1);
parts{1} = [ ...
'0.0046499993611292045887896602412298 0.0046499993611292045887896602412298 ' ...
'0.0046499993611292045887896602412298 '];
values = sscanf([parts{:}], '%f');
end
