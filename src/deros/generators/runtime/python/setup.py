"""The package deros_runtime, built by ament."""

from setuptools import find_packages, setup

package_name = 'deros_runtime'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(),
    package_data={package_name: ['py.typed']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='The deros authors',
    maintainer_email='maintainer@example.com',
    description='Runtime of the nodes that deros generates in Python.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'load_monitor = deros_runtime.load_monitor:main',
            'transform_monitor = deros_runtime.transform_monitor:main',
        ],
    },
)
