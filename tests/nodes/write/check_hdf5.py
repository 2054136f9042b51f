"""Opens files of write.hdf5 with h5py; hdf5_test.cpp wrote them to the working directory."""
import math
from fractions import Fraction

import h5py
import numpy as np

with h5py.File("track/s1.h5") as f:
    assert f.attrs["type"] == "Track" and f.attrs["type_version"] == 2, dict(f.attrs)
    assert f.attrs["item"] == "s1" and f.attrs["node"] == "track"
    assert f.attrs["made_by"].startswith("talkgraph ")
    assert f.attrs["provenance"].startswith('{"nodes"')
    values = f["values"]
    assert values.shape == (3, 2) and values.attrs["rate_hz"] == 30000 / 1001 and values.attrs["start_s"] == 0.02
    assert np.array_equal(values[:], [[0.5, -1], [2, math.nan], [1 / 3, 1e-300]], equal_nan=True)
    assert Fraction(f["rate"].asstr()[()]) == Fraction(30000, 1001) and f["rate"].attrs["unit"] == "Hz"
    assert f["start"][()] == 0.02
    assert list(f["names"].asstr("utf-8")) == ["jaw", "naïve"]
    assert list(f["lost"]) == [1]

with h5py.File("landmarks/s1.h5") as f:
    assert f["frames"].shape == (2, 3, 2) and f["frames"].attrs["unit"] == "pixel"
    assert f["frames"][1].tolist() == [[10, 20], [30, 40], [50, 60]]

with h5py.File("phones/s1.h5") as f:
    phones = f["phones"]
    assert list(zip(phones["label"].asstr(), phones["start"], phones["end"])) == [("sil", 0, 0.5), ("aa", 0.5, 0.75)]

with h5py.File("audio/s1.h5") as f:
    assert f["samples"][:].tolist() == [0, 0.5, -1] and f["samples"].attrs["rate_hz"] == f["rate"][()] == 16000

with h5py.File("video/s1.h5") as f:
    assert f["frames/size"][()] == 1 and bytes(f["frames/0/png"][:8]) == b"\x89PNG\r\n\x1a\n"

print("all is as written")
