"""Arrays of events: views, windows, representations, filters, files."""
import numpy as np
import pytest

import saccade
from saccade import Events


def some_events(count=1000, width=16, height=12, seed=1):
    random = np.random.default_rng(seed)
    return Events.from_columns(t=np.sort(random.integers(0, 10**8, count)), x=random.integers(0, width, count),
                               y=random.integers(0, height, count), p=random.integers(0, 2, count),
                               width=width, height=height)


def test_columns_have_the_stated_types_and_are_views(walls):
    events = walls.events
    assert [events[name].dtype for name in "txyp"] == [np.int64, np.uint16, np.uint16, np.bool_]
    assert all(np.shares_memory(events[name], events.data) for name in "txyp")
    assert np.shares_memory(events[100:200].data, events.data)
    assert np.shares_memory(events.between(0.1, 0.2).x, events.data)
    assert np.shares_memory(np.asarray(events), events.data)


def test_polarity_is_a_sound_bool_in_every_byte(walls):
    raw = walls.events.data.view(np.uint8).reshape(-1, 16)[:, 12]
    assert set(np.unique(raw)) == {0, 1}


def test_slices_by_time_and_by_count_hold_every_event_once():
    events = some_events()
    for parts in (list(events.slices(dt=0.0103)), list(events.slices(n=77))):
        assert np.array_equal(np.concatenate([part.data for part in parts]), events.data)
    assert all(len(part) == 77 for part in list(events.slices(n=77))[:-1])
    first = events.t[0]
    for k, part in enumerate(events.slices(dt=0.01)):
        assert ((part.t - first) // 10_000_000 == k).all()


def test_a_window_without_events_is_a_slice_too():
    events = Events.from_columns([0, 35_000_000], [1, 2], [1, 2], [1, 0], 4, 4)
    assert [len(part) for part in events.slices(dt=0.01)] == [1, 0, 0, 1]


def test_frames_count_events_by_pixel_and_polarity():
    events = some_events()
    expected = np.zeros((2, 12, 16), np.float32)
    np.add.at(expected, (np.where(events.p, 0, 1), events.y.astype(int), events.x.astype(int)), 1)
    assert np.array_equal(events.to_frame(), expected)
    assert np.array_equal(events.to_frame("count")[0], expected.sum(axis=0))


def test_a_time_surface_is_the_formula():
    events = some_events()
    end, decay = events.t[-1], 0.02
    expected = np.zeros((2, 12, 16))
    for event in events.data:  # in order of time: the last one stays
        expected[0 if event["p"] else 1, event["y"], event["x"]] = np.exp(-(end - event["t"]) * 1e-9 / decay)
    assert np.allclose(events.to_time_surface(decay), expected, atol=1e-6)


def test_a_voxel_grid_is_the_formula():
    events, bins = some_events(), 4
    t = (bins - 1) * (events.t - events.t[0]) / (events.t[-1] - events.t[0])
    expected = np.zeros((bins, 12, 16))
    for b in range(bins):
        weight = np.where(events.p, 1, -1) * np.maximum(0, 1 - np.abs(b - t))
        np.add.at(expected[b], (events.y.astype(int), events.x.astype(int)), weight)
    assert np.allclose(events.to_voxel_grid(bins), expected, atol=1e-4)
    assert events.to_voxel_grid(bins, polarity="separate").shape == (2 * bins, 12, 16)


def test_a_stated_window_holds_its_events_alone():
    events = some_events()
    window = events.between(0.02, 0.05)
    assert np.array_equal(events.to_frame(start_s=0.02, end_s=0.05), window.to_frame())
    assert np.isclose(np.abs(events.to_voxel_grid(start_s=0.02, end_s=0.05, polarity="separate")).sum(), len(window))


def test_filters_keep_what_they_say():
    events = some_events()
    assert events.on().p.all() and not events.off().p.any()
    assert len(events.on()) + len(events.off()) == len(events)
    part = events.crop(4, 3, 8, 6)
    assert part.size == (8, 6) and part.x.max() < 8 and part.y.max() < 6
    assert len(part) == ((events.x >= 4) & (events.x < 12) & (events.y >= 3) & (events.y < 9)).sum()
    mask = np.zeros((12, 16), bool)
    mask[5, 6] = True
    assert not ((events.without_pixels(mask).x == 6) & (events.without_pixels(mask).y == 5)).any()


def test_a_hot_pixel_is_found():
    events = some_events()
    hot = Events.from_columns(events.t, np.where(np.arange(1000) % 2, 3, events.x),
                              np.where(np.arange(1000) % 2, 2, events.y), events.p, 16, 12)
    assert np.argwhere(hot.hot_pixels()).tolist() == [[2, 3]]


def test_the_refractory_filter_leaves_no_close_pair_of_neighbours_in_time():
    events = some_events(4000)
    kept, gap = [], 300e3
    last = {}
    for event in events.data:
        pixel = (event["x"], event["y"])
        kept.append(pixel not in last or event["t"] - last[pixel] > gap)
        last[pixel] = event["t"]
    assert 0 < sum(kept) < len(events)
    assert np.array_equal(events.refractory(300).data, events.data[np.array(kept)])


def test_a_supported_event_has_a_neighbour_before_it():
    events = some_events()
    within, x, y = 2_000_000, events.x.astype(int), events.y.astype(int)
    expected = []
    for i in range(len(events)):
        apart = np.maximum(np.abs(x[:i] - x[i]), np.abs(y[:i] - y[i]))
        expected.append(((apart == 1) & (events.t[i] - events.t[:i] <= within)).any())
    assert 0 < sum(expected) < len(events)
    assert np.array_equal(events.supported(2000).data, events.data[np.array(expected)])


def test_files_of_every_format_are_streamed_alike(walls, tmp_path):
    for ending in (".h5", ".txt", ".npz"):
        file = tmp_path / ("events" + ending)
        walls.events.save(file)
        for slices in (saccade.EventsIterator(file, delta_t_us=10_000), saccade.EventsIterator(file, n_events=5000)):
            parts = list(slices)
            assert len(parts) > 3
            together = np.concatenate([part.data for part in parts])
            assert all(np.array_equal(together[name], walls.events[name]) for name in "txyp")
    parts = list(saccade.EventsIterator(walls.path, delta_t_us=10_000))
    expected = list(walls.events.slices(dt=0.01))
    assert [len(part) for part in parts] == [len(part) for part in expected]


def test_arrays_of_other_layouts_are_converted(walls):
    other = np.zeros(3, [("t", "i8"), ("x", "i4"), ("y", "i4"), ("p", "i1")])
    other["t"], other["p"] = [1, 2, 3], [1, -1, 0]
    assert Events(other, 4, 4).p.tolist() == [True, False, False]
    with pytest.raises(saccade.InputError, match="no field 'p'"):
        Events(np.zeros(3, [("t", "i8"), ("x", "i4"), ("y", "i4")]), 4, 4)


def test_events_beside_the_sensor_are_an_error():
    events = Events.from_columns([0, 1], [3, 4], [0, 0], [1, 1], 4, 4)
    with pytest.raises(saccade.InputError, match=r"events\[1\]: pixel \(4, 0\) is not on the sensor of 4 x 4 pixels"):
        events.to_frame()
