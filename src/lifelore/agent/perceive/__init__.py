"""The verbs `perceive`, `scenes` and `learn-relations`.

Read in this order: `perceive`, `perceive_many`, `cloud_folder`, `scene_files`; `scenes`; `learn_relations`.
"""
