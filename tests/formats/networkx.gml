graph [
  node [
    id 0
    label "A1"
    x 40.0
    y 0.0
    z 0.0
  ]
  node [
    id 1
    label "A2"
    x 20.0
    y 34.641016
    z 0.0
  ]
  node [
    id 2
    label "A3"
    x -20.0
    y 34.641016
    z 0.0
  ]
  node [
    id 3
    label "A4"
    x -40.0
    y 0.0
    z 0.0
  ]
  node [
    id 4
    label "A5"
    x -20.0
    y -34.641016
    z 0.0
  ]
  node [
    id 5
    label "A6"
    x 20.0
    y -34.641016
    z 0.0
  ]
  node [
    id 6
    label "B1"
    x 40.0
    y 0.0
    z 30.0
  ]
  node [
    id 7
    label "B2"
    x 20.0
    y 34.641016
    z 30.0
  ]
  node [
    id 8
    label "B3"
    x -20.0
    y 34.641016
    z 30.0
  ]
  node [
    id 9
    label "B4"
    x -40.0
    y 0.0
    z 30.0
  ]
  node [
    id 10
    label "B5"
    x -20.0
    y -34.641016
    z 30.0
  ]
  node [
    id 11
    label "B6"
    x 20.0
    y -34.641016
    z 30.0
  ]
  node [
    id 12
    label "C1"
    x 40.0
    y 0.0
    z 60.0
  ]
  node [
    id 13
    label "C2"
    x 20.0
    y 34.641016
    z 60.0
  ]
  node [
    id 14
    label "C3"
    x -20.0
    y 34.641016
    z 60.0
  ]
  node [
    id 15
    label "C4"
    x -40.0
    y 0.0
    z 60.0
  ]
  node [
    id 16
    label "C5"
    x -20.0
    y -34.641016
    z 60.0
  ]
  node [
    id 17
    label "C6"
    x 20.0
    y -34.641016
    z 60.0
  ]
  edge [
    source 0
    target 1
  ]
  edge [
    source 0
    target 6
  ]
  edge [
    source 0
    target 5
  ]
  edge [
    source 1
    target 2
  ]
  edge [
    source 1
    target 7
  ]
  edge [
    source 2
    target 3
  ]
  edge [
    source 2
    target 8
  ]
  edge [
    source 3
    target 4
  ]
  edge [
    source 3
    target 9
  ]
  edge [
    source 4
    target 5
  ]
  edge [
    source 4
    target 10
  ]
  edge [
    source 5
    target 11
  ]
  edge [
    source 6
    target 7
  ]
  edge [
    source 6
    target 12
  ]
  edge [
    source 6
    target 11
  ]
  edge [
    source 7
    target 8
  ]
  edge [
    source 7
    target 13
  ]
  edge [
    source 8
    target 9
  ]
  edge [
    source 8
    target 14
  ]
  edge [
    source 9
    target 10
  ]
  edge [
    source 9
    target 15
  ]
  edge [
    source 10
    target 11
  ]
  edge [
    source 10
    target 16
  ]
  edge [
    source 11
    target 17
  ]
  edge [
    source 12
    target 13
  ]
  edge [
    source 12
    target 17
  ]
  edge [
    source 13
    target 14
  ]
  edge [
    source 14
    target 15
  ]
  edge [
    source 15
    target 16
  ]
  edge [
    source 16
    target 17
  ]
]
