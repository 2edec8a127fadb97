"""The verbs `perceive`, `scenes` and `learn-relations`.

Read in this order: `perceive`, `perceive_many`, `views`, `cloud_folder`,
`source_files`, `scene_files`; `scenes`; `learn_relations`.
"""
