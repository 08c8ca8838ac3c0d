"""Topic suggestions: names from public ROS systems, and names that must not be suggested."""

from __future__ import annotations

import pytest

from deros.names.topic_likeness import LIKELY, LikelyTopics, is_mistyped, likeness
from tests.support.work import calls

# Subscribed topic, topics published with the same type, expected suggestions with the best first.
# Names are those of TurtleBot3, Nav2, Husky and Jackal, RealSense, ZED, Velodyne and Ouster
# drivers, u-blox and Microstrain drivers, imu_tools, imu_compass, robot_localization, slam_toolbox,
# and MoveIt.
PAIRS: list[tuple[str, list[str], list[str]]] = [
    ("/imu/data_compass", ["/imu/data", "/imu/data/bias"], ["/imu/data"]),
    (
        "/imu/data",
        ["/imu/data_raw", "/imu/mag", "/ekf/imu/data"],
        ["/ekf/imu/data", "/imu/data_raw"],
    ),
    ("/imu", ["/imu/data", "/imu_raw", "/vectornav/imu"], ["/vectornav/imu", "/imu_raw"]),
    ("/scan", ["/front/scan", "/scan_filtered"], ["/front/scan", "/scan_filtered"]),
    ("/front/scan", ["/rear/scan", "/scan"], ["/scan"]),
    ("/scan_fornt", ["/scan_front", "/scan_rear"], ["/scan_front"]),
    (
        "/odom",
        ["/husky_velocity_controller/odom", "/odometry/filtered"],
        ["/husky_velocity_controller/odom"],
    ),
    ("/odometry", ["/odom"], ["/odom"]),
    ("/odometry/filtered", ["/odometry/gps", "/odometry/filtered_map"], ["/odometry/filtered_map"]),
    ("/cmd_vel", ["/cmd_vel_nav", "/cmd_vel_smoothed"], ["/cmd_vel_nav", "/cmd_vel_smoothed"]),
    ("/cmd_vel_nav", ["/cmd_vel_teleop", "/cmd_vel_joy"], []),
    ("/cmd_vel_unstamped", ["/diff_drive/cmd_vel_unstamped"], ["/diff_drive/cmd_vel_unstamped"]),
    ("/command_velocity", ["/cmd_vel", "/cmd_pose"], ["/cmd_vel"]),
    ("/joint_state", ["/joint_states", "/joint_commands"], ["/joint_states"]),
    ("/initial_pose", ["/initialpose", "/goal_pose", "/amcl_pose"], ["/initialpose"]),
    ("/camera/image_raw", ["/camera/color/image_raw"], ["/camera/color/image_raw"]),
    ("/camera/left/image_raw", ["/camera/right/image_raw"], []),
    ("/camera1/image_raw", ["/camera2/image_raw"], []),
    ("/camera/color/camera_info", ["/camera/depth/camera_info"], []),
    ("/depth/points", ["/camera/depth/points"], ["/camera/depth/points"]),
    ("/velodyne_points", ["/velodyne/points", "/ouster/points"], ["/velodyne/points"]),
    ("/cloud", ["/velodyne_points", "/points"], ["/points", "/velodyne_points"]),
    ("/gps/fix", ["/ublox_gps_node/fix", "/fix"], ["/fix", "/ublox_gps_node/fix"]),
    ("/local_costmap/costmap", ["/global_costmap/costmap"], []),
    ("/plan", ["/local_plan", "/received_global_plan"], ["/local_plan"]),
    ("/battery_state", ["/battery/state", "/batt_state"], ["/batt_state", "/battery/state"]),
    ("/robot1/odom", ["/robot2/odom"], []),
    ("/rear/points", ["/near/points"], []),
    ("/scanFront", ["/scan_front"], ["/scan_front"]),
    ("/fmInformation/scan_front", ["/fmInformaton/scan_front"], ["/fmInformaton/scan_front"]),
]


def test_best_topics_are_suggested() -> None:
    """The right partner comes first, and unrelated topics are not suggested."""
    for wanted, published, advice in PAIRS:
        assert LikelyTopics(published).best(wanted, lambda _: 0.0) == advice, wanted


def test_likeness_is_symmetric() -> None:
    """Either of two names may be the wrong one."""
    for wanted, published, _ in PAIRS:
        for name in published:
            there, back = likeness(wanted, name), likeness(name, wanted)
            assert there == pytest.approx(back), (wanted, name)


def test_at_most_three_topics_are_suggested() -> None:
    """The best three are returned."""
    names = [f"/{place}/scan" for place in ("a", "b", "c", "d")]
    assert len(LikelyTopics(names).best("/scan", lambda _: 0.0)) == 3


def test_excluded_candidate_is_not_suggested() -> None:
    """An excluded candidate does not take the place of another."""
    names = ["/front/scan", "/scan_filtered"]
    suggested = LikelyTopics(names).best("/scan", lambda name: None if name in names[:1] else 0.0)
    assert suggested == names[1:]


def test_real_words_are_not_treated_as_typos() -> None:
    """Edit distance alone does not decide."""
    assert not is_mistyped("rear", "near")
    assert not is_mistyped("1", "2")
    assert is_mistyped("fornt", "front")
    assert is_mistyped("odmo", "odom")


def test_suggestions_do_not_look_at_each_of_ten_thousand_names() -> None:
    """A suggestion among ten times the names is no more work."""

    def work(carts: int) -> int:
        names = [f"/cart_{n}/stage_{m}" for n in range(carts) for m in range(9)]
        likely = LikelyTopics([*names, "/cart_7/braking", "/scan_front"])

        def suggest() -> None:
            for n in range(100):
                found = likely.best(f"/cart_{n}/brakign", lambda _: 0.0)
                assert found == (["/cart_7/braking"] * (n == 7))
            assert likely.best("/scan_fornt", lambda _: 0.0) == ["/scan_front"]

        suggest()  # and what is done once for all names
        return calls(suggest)

    assert work(1000) < 1.2 * work(100)
    assert likeness("/cart_7/brakign", "/cart_7/braking") > LIKELY
