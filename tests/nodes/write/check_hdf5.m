% Opens files of write.hdf5 with Octave; hdf5_test.cpp wrote them to the working directory.
% Octave numbers dimensions the other way round: frames are columns.
x = load("track/s1.h5");
assert(x.values, [0.5 2 1/3; -1 NaN 1e-300]);
assert(str2num(x.rate), 30000 / 1001);
assert(x.start, 0.02);
assert(cellstr(x.names), {"jaw"; "naïve"});
assert(double(x.lost), 1);

x = load("landmarks/s1.h5");
assert(size(x.frames), [2 3 2]);
assert(x.frames(:, :, 2)', [10 20; 30 40; 50 60]);

x = load("phones/s1.h5");
assert(cellstr(x.phones.label), {"sil"; "aa"});
assert(x.phones.start(:), [0; 0.5]);
assert(x.phones.end(:), [0.5; 0.75]);

x = load("audio/s1.h5");
assert(x.samples(:), [0; 0.5; -1]);
assert(x.rate, 16000);

x = load("video/s1.h5");
assert(double(x.frames._0.png(2:4)(:)'), double("PNG"));
disp("all is as written");
