from setuptools import setup

setup(
    name="lifelore_node",
    version="0.1.0",
    packages=["lifelore_node"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/lifelore_node"]),
        ("share/lifelore_node", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    entry_points={"console_scripts": ["lifelore_node = lifelore_node.node:main"]},
)
